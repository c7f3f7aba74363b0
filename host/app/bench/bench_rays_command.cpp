// `sundog bench rays`: the tracer alone, on the rays of a frame by kind.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <sstream>

#include "app/bench/bench_options.h"
#include "app/options/option_helpers.h"
#include "app/options/option_values.h"
#include "base/clock.h"
#include "base/error.h"
#include "bench/rays/check_hits.h"
#include "bench/rays/ray_sets.h"
#include "bench/rays/ray_tracer.h"
#include "render/device/kernel_config.h"

namespace sundog {
namespace {

struct RaysOptions : BenchOptions {
  std::string rays = "1024", kinds;
  bool no_times = false;
};

/// Which rays are timed.
struct RaysWanted {
  unsigned size;
  std::vector<std::string> kinds;  // empty: all
};

/// One kind of rays of one scene on one device.
struct RayTimes {
  std::string kind;
  std::size_t rays = 0;
  HitCheck check;
  std::optional<Spread> mrays;         // none where only the answers are checked
  std::optional<Spread> kernel_mrays;  // by the device's events, where the driver gives times
};

/// The answers of the tracer's last run.
Answers answers_of(RayTracer& tracer, const RaySet& set) {
  return set.any ? Answers{{}, tracer.occluded()} : Answers{tracer.hits(), {}};
}

/// "primary,shadow": of which kinds; empty: of all. Throws UsageError.
std::vector<std::string> parse_kinds(const std::string& text) {
  std::vector<std::string> kinds;
  std::istringstream in(text);
  for (std::string kind; std::getline(in, kind, ',');) {
    if (std::ranges::count(ray_kinds, kind) == 0)
      throw UsageError(fmt::format("--kinds '{}': wanted some of {} with commas between", text,
                                   fmt::join(ray_kinds, ", ")));
    kinds.push_back(kind);
  }
  return kinds;
}

RayTimes time_rays(const std::string& name, const CompiledScene& scene, const RaySet& set, RayTracer& tracer,
                   int repeat) {
  RayTimes times;
  times.kind = set.kind;
  times.rays = set.rays.size();
  tracer.upload(set.rays);
  tracer.run({set.any, set.coherent});
  times.check = check_hits(scene, set, answers_of(tracer, set));
  if (times.check.differ > 0)
    throw DeviceError(fmt::format("{}: {} of {} {} rays have wrong answers, so nothing was timed", name,
                                  times.check.differ, times.check.checked, set.kind));
  if (!times.check.plain_is_sound())
    throw DeviceError(
        fmt::format("{}: the host's plain tracer has wrong answers to {} of {} {} rays, so nothing was "
                    "timed",
                    name, times.check.plain_wrong, times.check.checked, set.kind));
  const double millions = 1e-6 * static_cast<double>(set.rays.size());
  std::vector<double> rates, kernel_rates;
  for (int i = 0; i < repeat; ++i) {
    const Stopwatch clock;
    const double kernel_seconds = tracer.run({set.any, set.coherent});
    rates.push_back(millions / clock.seconds());
    if (kernel_seconds > 0) kernel_rates.push_back(millions / kernel_seconds);
  }
  if (rates.empty()) return times;
  times.mrays = spread(rates);
  if (kernel_rates.size() == rates.size()) times.kernel_mrays = spread(kernel_rates);
  return times;
}

std::vector<RayTimes> time_scene(const CompiledScene& scene, Device& device, const RaysOptions& options,
                                 const RaysWanted& wanted, const std::string& name) {
  RayTracer tracer(device, scene);
  const TraceFunction trace = [&](std::span<const Ray> rays) { return tracer.trace(rays); };
  std::vector<RayTimes> times;
  for (const RaySet& set : frame_rays(scene, scene_viewpoint(scene), wanted.size, trace, wanted.kinds)) {
    show_step(options, fmt::format("{}: {} rays", name, set.kind));
    times.push_back(time_rays(name, scene, set, tracer, options.no_times ? 0 : options.repeat));
  }
  return times;
}

void add_rows(Report& report, const std::string& scene, const DeviceInfo& device, const std::string& tracer,
              const std::vector<RayTimes>& times) {
  Table table{fmt::format("{} on {}, {} tracer", scene, device.label(), tracer),
              {{"kind", ""},
               {"rays", ""},
               {"hits", "%"},
               {"rate", "Mrays/s"},
               {"kernel", "Mrays/s"},
               {"checked", ""}},
              {}};
  BarPlot bars{table.title, "Mrays/s", {}};
  for (const RayTimes& t : times) {
    const double hits = 100.0 * static_cast<double>(t.check.hits) / static_cast<double>(t.rays);
    const Cell rate = t.mrays ? Cell(*t.mrays) : Cell(),
               kernel = t.kernel_mrays ? Cell(*t.kernel_mrays) : Cell();
    const std::string checked = fmt::format("{}, {} by rounding", t.check.checked, t.check.rounded);
    table.rows.push_back({t.kind, static_cast<double>(t.rays), hits, rate, kernel, checked});
    if (t.mrays) bars.bars.push_back({t.kind, *t.mrays, fmt::format("{} rays", t.rays)});
    const auto number = [](std::size_t n) { return static_cast<double>(n); };
    report.measurements.rows.push_back({scene, device.label(), t.kind, number(t.rays), number(t.check.hits),
                                        number(t.check.checked), number(t.check.rounded),
                                        number(t.check.differ), rate, tracer, kernel});
  }
  report.parts.emplace_back(std::move(table));
  if (!bars.bars.empty()) report.parts.emplace_back(std::move(bars));
}

/// What the report says of a scene before any time.
std::string describe(const CompiledScene& scene) {
  const u32 fields = scene.info.field_end - scene.info.instance_count;
  const std::string left_out = fields ? fmt::format("{} distance field{} left out: marched, not traced",
                                                    fields, fields == 1 ? "" : "s")
                                      : "";
  if (scene.info.instance_count == 0)
    return (left_out.empty() ? "an empty scene" : left_out) + "; nothing to time";
  return fmt::format("{} triangles, BVH built in {:.1f} ms, SAH cost {:.2f}{}{}", scene.figures.triangles,
                     scene.figures.build_seconds * 1e3, scene.figures.sah_cost, fields ? "; " : "", left_out);
}

int bench_rays(const RaysOptions& options) {
  const RaysWanted wanted{static_cast<unsigned>(parse_number("--rays", options.rays, 1, 16384)),
                          parse_kinds(options.kinds)};
  Report report = new_report("rays", "Rays a second by kind", options);
  report.measurements.columns = {{"scene", ""},       {"device", ""},  {"kind", ""},         {"rays", ""},
                                 {"hits", ""},        {"checked", ""}, {"rounded", ""},      {"differ", ""},
                                 {"rate", "Mrays/s"}, {"tracer", ""},  {"kernel", "Mrays/s"}};
  const std::vector<DeviceInfo> devices = bench_devices(options);
  add_device_facts(report, devices);
  for (const std::string& file : options.scenes) {
    const CompiledScene scene = bench_scene(file, options);
    const std::string name = scene_name(file);
    report.facts.emplace_back(name, describe(scene));
    if (scene.info.instance_count == 0) continue;
    for (const DeviceInfo& info : devices) {
      Device device(info);
      const char* tracer = traces_compact(scene, info) ? "compact" : "wide";
      add_rows(report, name, info, tracer, time_scene(scene, device, options, wanted, name));
    }
  }
  if (!options.no_times)
    report.notes.push_back(fmt::format(
        "Median of {} launches by the wall clock, each waited for; `kernel` is by the device's events, if "
        "its driver gives times. Shadow rays ask for any hit, the others for the nearest. Distance fields "
        "are marched, not traced, and left out; `bench threads` and `bench devices` time their frames.",
        options.repeat));
  report.notes.emplace_back(
      "Every answer is checked by the host's own tracer and, where the two differ, in double precision. "
      "`by rounding` counts the answers that differ and where both are right; where the plain tracer is "
      "wrong for one ray in a thousand, nothing is timed.");
  return publish(report, options);
}

}  // namespace

void add_bench_rays(Arguments& bench, Command& chosen) {
  const auto options = std::make_shared<RaysOptions>();
  Arguments* app =
      bench.add_subcommand("rays", "Rays a second by kind: camera, shadow, bounce, reflection, glass");
  add_bench_options(app, *options);
  value(app, "--rays", "N", options->rays, "camera rays a side (default 1024)");
  value(app, "--kinds", "NAMES", options->kinds,
        fmt::format("some of {} (default all)", fmt::join(ray_kinds, ",")));
  app->add_flag("--no-times", options->no_times, "only check the answers");
  app->callback([options, &chosen] { chosen = RunLater{[options] { return bench_rays(*options); }}; });
}

}  // namespace sundog
