// `sundog bench rays`: times the tracer alone on the rays of a frame, by kind.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <sstream>

#include "app/options/option_helpers.h"
#include "app/options/option_values.h"
#include "base/error.h"
#include "bench/commands/bench_run.h"
#include "bench/rays/ray_sets.h"
#include "bench/rays/ray_times.h"

namespace sundog {
namespace {

struct RaysOptions : BenchOptions {
  std::string rays = "1024", kinds;
  bool no_times = false;
};

/// Parses "primary,shadow"; empty: all kinds. Throws UsageError for an unknown kind.
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

/// The report's line about a scene: its contents and the parts that are left out.
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
  const auto size = static_cast<unsigned>(parse_number("--rays", options.rays, 1, 16384));
  const std::vector<std::string> kinds = parse_kinds(options.kinds);
  BenchRun run("rays", "Rays a second by kind", options);
  Report& head = run.head();
  if (!options.no_times)
    head.notes.emplace_back(
        "Medians of launches by the wall clock, each waited for; `kernel` is by the device's events, if "
        "its driver gives times. Shadow rays ask for any hit, the others for the nearest. Distance fields "
        "are marched, not traced, and left out; `bench threads` and `bench devices` time their frames.");
  head.notes.emplace_back(
      "Every answer is checked by the host's own tracer and, where the two differ, in double precision; "
      "later runs must have the same answers to the bit. `by rounding` counts the answers that differ and "
      "where both are right; where the plain tracer is wrong for one ray in a thousand, nothing is timed.");
  const std::vector<DeviceInfo> devices = run.devices();
  for (const std::string& file : options.scenes) {
    const auto scene = run.compiled(file);
    head.facts.emplace_back(scene_name(options, file), describe(*scene));
    if (scene->info.instance_count == 0) continue;
    for (const DeviceInfo& info : devices)
      run.measure(std::make_shared<RayTimes>(scene_name(options, file), scene, info, size, kinds), 0,
                  options.no_times ? 0 : options.repeat);
  }
  return run.publish(true);
}

}  // namespace

void add_bench_rays(Arguments& bench, Command& chosen) {
  const auto options = std::make_shared<RaysOptions>();
  Arguments* app = add_bench_command(bench, chosen, "rays",
                                     "Rays a second by kind: camera, shadow, bounce, reflection, glass",
                                     options, bench_rays);
  value(app, "--rays", "N", options->rays, "camera rays a side (default 1024)");
  value(app, "--kinds", "NAMES", options->kinds,
        fmt::format("some of {} (default all)", fmt::join(ray_kinds, ",")));
  app->add_flag("--no-times", options->no_times, "only check the answers");
}

}  // namespace sundog
