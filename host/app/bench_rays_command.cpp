// `sundog bench rays`: the tracer alone, on the rays of a frame by kind.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "app/bench_options.h"
#include "app/option_helpers.h"
#include "app/option_values.h"
#include "base/clock.h"
#include "base/error.h"
#include "bench/plain/tracer.h"
#include "bench/ray_sets.h"
#include "bench/ray_tracer.h"

namespace sundog {
namespace {

constexpr std::size_t checked_rays = 4096;  // of each kind, against the host
constexpr double allowed_differences = 1e-3;

struct RaysOptions : BenchOptions {
  std::string size = "1024";
};

/// One kind of rays of one scene on one device.
struct RayTimes {
  std::string kind;
  std::size_t rays = 0, hits = 0, checked = 0, differ = 0;
  Spread mrays;
};

plain::Ray plain_ray(const Ray& ray) {
  return {{ray.ox, ray.oy, ray.oz}, {ray.dx, ray.dy, ray.dz}, ray.t_min, ray.t_max};
}

/// Looks some rays up with the host's own tracer. Rays past silhouettes and along edges may fall to either
/// side.
void check_hits(const CompiledScene& scene, const RaySet& set, RayTracer& tracer, RayTimes& times) {
  const std::vector<Hit> hits = set.any ? std::vector<Hit>{} : tracer.hits();
  const std::vector<u32> occluded = set.any ? tracer.occluded() : std::vector<u32>{};
  const auto hit = [&](std::size_t i) {
    return set.any ? occluded[i] != 0 : hits[i].instance != NO_INSTANCE;
  };
  for (std::size_t i = 0; i < set.rays.size(); ++i) times.hits += hit(i);
  const std::size_t stride = std::max<std::size_t>(1, set.rays.size() / checked_rays);
  for (std::size_t i = 0; i < set.rays.size(); i += stride) {
    plain::Hit expected;
    const bool found = plain::closest_hit(scene, plain_ray(set.rays[i]), expected);
    const bool same = hit(i) == found &&
                      (set.any || !found || std::abs(hits[i].t - expected.t) <= 1e-4f * std::abs(expected.t));
    ++times.checked;
    times.differ += !same;
  }
}

RayTimes time_rays(const CompiledScene& scene, const RaySet& set, RayTracer& tracer, int repeat) {
  RayTimes times;
  times.kind = set.kind;
  times.rays = set.rays.size();
  tracer.upload(set.rays);
  tracer.run({set.any, set.coherent});
  check_hits(scene, set, tracer, times);
  if (static_cast<double>(times.differ) > allowed_differences * static_cast<double>(times.checked) + 1)
    throw DeviceError(fmt::format("{} of {} {} rays that the host traced too differ: no time counts",
                                  times.differ, times.checked, set.kind));
  std::vector<double> rates;
  for (int i = 0; i < repeat; ++i) {
    const Stopwatch clock;
    tracer.run({set.any, set.coherent});
    rates.push_back(static_cast<double>(set.rays.size()) / clock.seconds() * 1e-6);
  }
  times.mrays = spread(rates);
  return times;
}

std::vector<RayTimes> time_scene(const CompiledScene& scene, Device& device, const RaysOptions& options,
                                 const std::string& name) {
  RayTracer tracer(device, scene);
  const TraceFunction trace = [&](std::span<const Ray> rays) { return tracer.trace(rays); };
  const Viewpoint view = scene_viewpoint(scene);
  std::vector<RaySet> sets{
      primary_rays(view, static_cast<unsigned>(parse_number("--size", options.size, 1, 16384)))};
  for (RaySet& set : secondary_rays(scene, view, sets[0], trace)) sets.push_back(std::move(set));
  std::vector<RayTimes> times;
  for (const RaySet& set : sets) {
    show_step(options, fmt::format("{}: {} rays", name, set.kind));
    if (!set.rays.empty()) times.push_back(time_rays(scene, set, tracer, options.repeat));
  }
  return times;
}

void add_rows(Report& report, const std::string& scene, const DeviceInfo& device,
              const std::vector<RayTimes>& times) {
  Table table{fmt::format("{} on {}", scene, device.label()),
              {{"kind", ""}, {"rays", ""}, {"hits", "%"}, {"rate", "Mrays/s"}, {"differ", ""}},
              {}};
  BarPlot bars{table.title, "Mrays/s", {}};
  for (const RayTimes& t : times) {
    const double hits = 100.0 * static_cast<double>(t.hits) / static_cast<double>(t.rays);
    const std::string differ = fmt::format("{} of {}", t.differ, t.checked);
    table.rows.push_back({t.kind, static_cast<double>(t.rays), hits, t.mrays, differ});
    bars.bars.push_back({t.kind, t.mrays, fmt::format("{} rays", t.rays)});
    report.measurements.rows.push_back({scene, device.label(), t.kind, static_cast<double>(t.rays),
                                        static_cast<double>(t.hits), static_cast<double>(t.checked),
                                        static_cast<double>(t.differ), t.mrays});
  }
  report.parts.emplace_back(std::move(table));
  report.parts.emplace_back(std::move(bars));
}

/// What the report says of a scene before any time.
std::string describe(const CompiledScene& scene) {
  const u32 fields = scene.info.field_end - scene.info.instance_count;
  const std::string left_out = fields ? fmt::format("{} distance field{}: marched, not traced, and left out",
                                                    fields, fields == 1 ? "" : "s")
                                      : "";
  if (scene.info.instance_count == 0)
    return (left_out.empty() ? "an empty scene" : left_out) + "; so there is nothing to time";
  return fmt::format("{} triangles, BVH built in {:.1f} ms, SAH cost {:.2f}{}{}", scene.figures.triangles,
                     scene.figures.build_seconds * 1e3, scene.figures.sah_cost, fields ? "; " : "", left_out);
}

int bench_rays(const RaysOptions& options) {
  Report report = new_report("rays", "Rays a second by kind", options);
  report.measurements.columns = {{"scene", ""}, {"device", ""},  {"kind", ""},   {"rays", ""},
                                 {"hits", ""},  {"checked", ""}, {"differ", ""}, {"rate", "Mrays/s"}};
  const std::vector<DeviceInfo> devices = bench_devices(options);
  for (const DeviceInfo& info : devices)
    report.facts.emplace_back("device", info.label() + ", " + info.driver);
  for (const std::string& file : options.scenes) {
    const CompiledScene scene = bench_scene(file, options);
    const std::string name = scene_name(file);
    report.facts.emplace_back(name, describe(scene));
    if (scene.info.instance_count == 0) continue;
    for (const DeviceInfo& info : devices) {
      Device device(info);
      add_rows(report, name, info, time_scene(scene, device, options, name));
    }
  }
  report.notes.push_back(fmt::format(
      "Median of {} launches by the wall clock, each waited for. Shadow rays ask for any hit, the others for "
      "the nearest. Distance fields are marched, not traced, and left out: `bench threads` and `bench "
      "devices` "
      "time their frames. `differ`: of the rays that the "
      "host traced too, those with another answer.",
      options.repeat));
  return publish(report, options);
}

}  // namespace

void add_bench_rays(CLI::App& bench, Command& chosen) {
  const auto options = std::make_shared<RaysOptions>();
  CLI::App* app =
      bench.add_subcommand("rays", "Rays a second by kind: camera, shadow, bounce, reflection, glass");
  add_bench_options(app, *options);
  value(app, "--size", "N", options->size, "pixels a side of the camera's rays (default 1024)");
  app->callback([options, &chosen] { chosen = RunLater{[options] { return bench_rays(*options); }}; });
}

}  // namespace sundog
