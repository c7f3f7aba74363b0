// Formats times, rays and devices as JSON and text; losses() reports rays and samples that were dropped.
#include "app/render/stats.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <nlohmann/json.hpp>

#include "app/process/scene_figures.h"
#include "app/render/stray_exits.h"
#include "device/energy.h"
#include "render/film/sampling_report.h"
#include "scene/integrators.h"

namespace sundog {
namespace {

using nlohmann::json;

json image_json(const RenderCommand& command, const SceneDescription& scene, const RenderResult& result) {
  return {{"file", command.out},
          {"width", result.film.width},
          {"height", result.film.height},
          {"samples", scene.render.samples},
          {"max_depth", scene.render.max_depth},
          {"integrator", scene.render.integrator},
          {"aovs", command.aovs},
          {"complete", result.complete}};
}

/// Sampling statistics of a frame rendered in passes; null for other frames.
json sampling_json(const SceneDescription& scene, const RenderResult& result) {
  if (result.film.taken.empty()) return nullptr;
  const SamplingFigures figures = sampling_figures(
      result.film.taken, result.film.done, result.film.surfaces_seen, static_cast<u32>(scene.render.samples));
  return {{"passes", result.film.stage},
          {"samples", figures.samples},
          {"samples_a_pixel", figures.mean},
          {"most", figures.most},
          {"interpolated", figures.share_interpolated},
          {"surface_rays", result.film.surfaces_seen},
          {"camera_rays_saved", figures.saved},
          {"time_limited", result.time_limited}};
}

std::string host_name() {
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "";
}

/// [x, y], or "driver" if the driver chose the size.
json work_group_json(const KernelTimes& times) {
  return times.local_x > 0 ? json{times.local_x, times.local_y} : json("driver");
}

json device_json(const DeviceReport& report) {
  json kernels = json::object();
  for (const auto& [name, times] : report.kernels)
    kernels[name] = {{"launches", times.launches},
                     {"device_ms", times.device_ms},
                     {"host_ms", times.host_ms},
                     {"first_ms", times.first_ms},
                     {"work_group", work_group_json(times)}};
  return {{"index", report.info.place()},
          {"platform", report.info.platform_name},
          {"name", report.info.name},
          {"driver", report.info.driver},
          {"rank", report.info.rank},
          {"host", report.info.host.empty() ? host_name() : report.info.host},
          {"sub_units", report.info.sub_units},
          {"first_unit", report.info.first_unit},
          {"tiles", report.tiles},
          {"outrun", report.outrun},
          {"pixels", report.pixels},
          {"share", report.share},
          {"failures", report.failures},
          {"ready", report.ready},
          {"retired", report.retired},
          {"abandoned", report.abandoned},
          {"busy_seconds", report.busy_seconds},
          {"kernels_cached", report.kernels_cached},
          {"messages", report.messages},
          {"notes", report.notes},
          {"kernels", kernels}};
}

json counters_json(const RayCounts& counts) {
  return {{"primary_hit", counts[COUNT_PRIMARY_HIT]},
          {"cut_off", counts[COUNT_CUT_OFF]},
          {"depth_limit", counts[COUNT_DEPTH_LIMIT]},
          {"camera_depth_limit", counts[COUNT_CAMERA_DEPTH_LIMIT]},
          {"ray_stack_overflow", counts[COUNT_RAY_STACK_OVERFLOW]},
          {"media_stack_overflow", counts[COUNT_MEDIA_STACK_OVERFLOW]},
          {"non_finite", counts[COUNT_NON_FINITE]},
          {"stray_exit", counts[COUNT_STRAY_EXIT]},
          {"lost_media_pixel", counts[COUNT_LOST_PIXEL]},
          {"shadow_limit", counts[COUNT_SHADOW_LIMIT]},
          {"march_limit", counts[COUNT_MARCH_LIMIT]},
          {"march_budget", counts[COUNT_MARCH_BUDGET]},
          {"march_taken_back", counts[COUNT_MARCH_BACK]}};
}

/// The ledger's entries, in the order of the work.
std::vector<std::pair<const char*, double>> entries(const TimeLedger& times) {
  return {{"load", times.load},
          {"compile_scene", times.compile_scene},
          {"build_kernels", times.render.build_kernels},
          {"upload", times.render.upload},
          {"render", times.render.render},
          {"readback", times.render.readback},
          {"write", times.write},
          {"other", times.other()},
          {"total", times.total}};
}

/// The process's peak memory in bytes, as the system counts it.
std::uint64_t peak_memory() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

std::string work_group_text(const KernelTimes& times) {
  return times.local_x > 0 ? fmt::format("{}x{}", times.local_x, times.local_y) : "chosen by the driver";
}

std::string device_text(const DeviceReport& report) {
  std::string text = fmt::format("  {}: {:.1f} % of the pixels, {} tiles in {:.3f} s", report.info.label(),
                                 100 * report.share, report.tiles, report.busy_seconds);
  if (report.outrun > 0) text += fmt::format(", {} outrun by others", report.outrun);
  if (report.ready)
    text += report.kernels_cached ? ", kernels from the cache" : ", kernels compiled";
  else if (!report.retired)
    text += ", not ready before the end";
  if (report.retired) text += ", retired";
  text += "\n";
  for (const auto& [name, kernel] : report.kernels)
    text += fmt::format("    {:<20} {:6} launches {:10.1f} ms  work-group {}\n", name, kernel.launches,
                        kernel.device_ms > 0 ? kernel.device_ms : kernel.host_ms, work_group_text(kernel));
  return text;
}

}  // namespace

json rays_json(const RayCounts& counts) {
  return {{"primary", counts[COUNT_PRIMARY]},
          {"reflection", counts[COUNT_REFLECTION]},
          {"refraction", counts[COUNT_REFRACTION]},
          {"shadow", counts[COUNT_SHADOW]},
          {"march_steps", counts[COUNT_MARCH_STEPS]}};
}

json stats_json(const RenderCommand& command, const SceneDescription& scene, const CompiledScene& flat,
                const RenderResult& result, const TimeLedger& times) {
  json devices = json::array();
  for (const DeviceReport& report : result.devices) devices.push_back(device_json(report));
  return {{"schema", 1},
          {"sundog", SUNDOG_VERSION},
          {"scene", scene_figures(scene, flat)},
          {"image", image_json(command, scene, result)},
          {"sampling", sampling_json(scene, result)},
          {"devices", devices},
          {"efficiency", result.efficiency},
          {"rays", rays_json(result.counts)},
          {"counters", counters_json(result.counts)},
          {"kernels_cached", times.render.cached},
          {"energy", energy_json(times.joules, times.frame, times.joules_by)},
          {"draft_pictures", times.draft_pictures},
          {"peak_memory", peak_memory()}};
}

json seconds_json(const TimeLedger& times) {
  json seconds;
  for (const auto& [step, value] : entries(times)) seconds[step] = value;
  return seconds;
}

std::uint64_t ray_count(const RayCounts& counts) {
  return counts[COUNT_PRIMARY] + counts[COUNT_REFLECTION] + counts[COUNT_REFRACTION] + counts[COUNT_SHADOW];
}

std::vector<std::string> losses(const RayCounts& counts, const SceneDescription& scene) {
  struct Loss {
    int counter;
    const char* what;
  };
  constexpr Loss kinds[] = {
      {COUNT_RAY_STACK_OVERFLOW, "rays were dropped because the ray stack was full: lower max_depth"},
      {COUNT_SHADOW_LIMIT, "shadow rays were given up after too many transmissive surfaces"},
      {COUNT_MARCH_BUDGET,
       "marches through a field were not made because the pixels had cost too much: lower its iterations, "
       "step_limit or max_depth"},
      {COUNT_CAMERA_DEPTH_LIMIT,
       "camera rays went straight through more surfaces than max_depth allows and are dark behind them: "
       "raise max_depth"},
      {COUNT_NON_FINITE, "samples were dropped because they were not finite"}};
  std::vector<std::string> sentences;
  if (const std::uint64_t deep = counts[COUNT_DEPTH_LIMIT]; deep > 0 && scene.render.max_depth >= depth_cap)
    sentences.push_back(fmt::format(
        "{} paths were ended at max_depth, {}: give mirrors and media that lose no light a reflection or "
        "albedo below 1, or raise max_depth",
        deep, scene.render.max_depth));
  for (const Loss& kind : kinds)
    if (const std::uint64_t count = counts[static_cast<std::size_t>(kind.counter)])
      sentences.push_back(fmt::format("{} {}", count, kind.what));
  if (const std::uint64_t deep = counts[COUNT_MEDIA_STACK_OVERFLOW])
    sentences.push_back(
        fmt::format("{} rays entered more solids inside each other than the media stack holds, 8, {}: "
                    "take some of them apart",
                    deep, lost_pixels(counts, scene)));
  // Rays that start within rounding of a closed mesh's edge cause a few; an open mesh causes many more.
  constexpr std::uint64_t rays_per_stray = 1'000'000;
  const std::uint64_t strays = counts[COUNT_STRAY_EXIT];
  if (strays > 0 && strays * rays_per_stray >= ray_count(counts))
    for (std::string& sentence : explain_stray_exits(counts, scene)) sentences.push_back(std::move(sentence));
  return sentences;
}

std::vector<std::string> failures_text(const DeviceReport& report) {
  std::vector<std::string> sentences;
  // A failing driver may repeat the same message many times.
  for (std::size_t i = 0; i < report.messages.size(); ++i) {
    const std::string& message = report.messages[i];
    std::size_t times = 1;
    for (; i + 1 < report.messages.size() && report.messages[i + 1] == message; ++i) ++times;
    sentences.push_back(times > 1 ? fmt::format("{} ({} times)", message, times) : message);
  }
  if (report.retired && !sentences.empty()) sentences.back() += "; the device was retired";
  return sentences;
}

std::string details_text(const RenderResult& result, const TimeLedger& times) {
  std::string text;
  for (const auto& [step, seconds] : entries(times))
    text += fmt::format("  {:<22} {:10.1f} ms\n", step, 1000 * seconds);
  for (const json& group : {rays_json(result.counts), counters_json(result.counts)})
    for (const auto& [kind, count] : group.items())
      text += fmt::format("  {:<22} {:10}\n", kind, count.get<std::uint64_t>());
  text +=
      fmt::format("  {:<22} {:10.1f} MiB\n", "peak_memory", static_cast<double>(peak_memory()) / (1 << 20));
  for (const DeviceReport& report : result.devices) text += device_text(report);
  if (result.devices.size() > 1)
    text += fmt::format("  {:<22} {:10.1f} %\n", "efficiency", 100 * result.efficiency);
  return text;
}

}  // namespace sundog
