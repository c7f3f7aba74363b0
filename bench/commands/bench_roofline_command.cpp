// `sundog bench roofline`: a device's peaks, and how close the tracer's kernels come to them.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "app/options/option_helpers.h"
#include "bench/commands/bench_run.h"
#include "bench/rays/ray_times.h"
#include "bench/report/machine.h"
#include "bench/roofline/device_peaks.h"
#include "bench/roofline/ray_work.h"
#include "render/device/kernel_config.h"

namespace sundog {
namespace {

struct TracedScene {
  std::string name;
  std::shared_ptr<const CompiledScene> scene;
};

struct Roof {
  std::string name;
  Spread bandwidth;
};

/// Rises with the bandwidth to the peak, then is level, from `low` to `high` operations a byte.
Curve roof_curve(const Roof& roof, const Spread& peak, double low, double high) {
  const double ridge = peak.median / roof.bandwidth.median;
  Curve curve{roof.name, {}};
  if (low < ridge) curve.points.push_back({low, scaled(roof.bandwidth, low)});
  curve.points.push_back({ridge, peak});
  if (high > ridge) curve.points.push_back({high, peak});
  return curve;
}

/// Plots the roofs above the points, which are curves of one point each.
CurvePlot plot_of(const std::string& title, const std::vector<Roof>& roofs, const Spread& peak,
                  const std::vector<Curve>& points) {
  CurvePlot plot{title, "operations a byte", "Gop/s", {}, false, true};
  double low = 0.5, high = 10;
  for (const Curve& curve : points)
    low = std::min(low, curve.points[0].x / 2), high = std::max(high, curve.points[0].x * 2);
  for (const Roof& roof : roofs) high = std::max(high, 2 * peak.median / roof.bandwidth.median);
  for (const Roof& roof : roofs) plot.curves.push_back(roof_curve(roof, peak, low, high));
  plot.curves.insert(plot.curves.end(), points.begin(), points.end());
  return plot;
}

class Roofline {
 public:
  /// `rays`: camera rays a side.
  Roofline(const DeviceInfo& device, unsigned megabytes, const std::vector<TracedScene>& scenes,
           unsigned rays)
      : info_(device), peaks_(device, megabytes) {
    for (const TracedScene& scene : scenes)
      traced_.push_back({scene, std::make_shared<RayTimes>(scene.name, scene.scene, device, rays,
                                                           std::vector<std::string>{})});
  }

  void measure(const MeasureOptions& options) {
    peaks_.measure(options);
    for (const Traced& traced : traced_)
      if (!options.is_stopped()) traced.times->measure(options);
  }

  void add_to(Report& report) const {
    peaks_.add_to(report);
    const auto memory = peaks_.best("read memory"), cache = peaks_.best("read cache"),
               peak = peaks_.best("float");
    if (traced_.empty() && memory && cache && peak)
      report.parts.emplace_back(plot_of(fmt::format("Roofline of {}", device_title(info_)),
                                        {{"cache", *cache}, {"memory", *memory}}, *peak, {}));
    for (const Traced& traced : traced_) {
      Report rays;
      traced.times->add_to(rays);
      for (const MeasuredWay& way : rays.ways)
        if (!way.is_good()) add_measured(report, way, place_of(traced));
      add_scene(report, traced);
    }
  }

 private:
  struct Traced {
    TracedScene scene;
    std::shared_ptr<RayTimes> times;
  };
  std::vector<Field> place_of(const Traced& traced) const {
    return {{"scene", "", traced.scene.name}, {"device", "", device_title(info_)}};
  }
  void add_scene(Report& report, const Traced& traced) const {
    const bool compact = traces_compact(*traced.scene.scene, info_);
    Table table{fmt::format("{} on {}: work of a ray", traced.scene.name, device_title(info_)), {}, {}};
    std::vector<Curve> points;
    const auto memory = peaks_.best("read memory"), cache = peaks_.best("read cache"),
               peak = peaks_.best("float");
    for (const RayTimes::Timed& timed : traced.times->timed()) {
      const RayWork work = ray_work(*traced.scene.scene, *timed.set, compact);
      const Spread operations = scaled(timed.rate, 1e-3 * work.operations);
      std::vector<Field> key = place_of(traced);
      key.push_back({"kind", "", timed.set->kind});
      std::vector<Field> shown{key.back(),
                               {"nodes", "", work.nodes},
                               {"blocks", "", work.blocks},
                               {"work", "op", work.operations},
                               {"asked for", "B", work.bytes},
                               {"at least", "B", work.least_bytes},
                               {"intensity", "op/B", work.intensity()},
                               {"rate", "Gop/s", operations},
                               {"traffic", "GB/s", scaled(timed.rate, 1e-3 * work.bytes)}};
      if (cache && memory && peak) {
        // Bytes that must come from memory come at memory speed, requested bytes at cache speed.
        const double bound = std::min({peak->median, cache->median * work.intensity(),
                                       memory->median * work.operations / work.least_bytes});
        shown.push_back({"of the roof", "%", 100 * operations.median / bound});
      }
      add_row(table, shown, *timed.way);
      shown.front() = {"rays", "Mrays/s", timed.rate};
      add_measured(report, *timed.way, key, shown);
      points.push_back({timed.set->kind, {{work.intensity(), operations}}});
    }
    if (table.rows.empty()) return;
    report.parts.emplace_back(std::move(table));
    if (cache && memory && peak)
      report.parts.emplace_back(
          plot_of(fmt::format("{} under the roofline of {}", traced.scene.name, device_title(info_)),
                  {{"cache", *cache}, {"memory", *memory}}, *peak, points));
  }

  DeviceInfo info_;
  DevicePeaks peaks_;
  std::vector<Traced> traced_;
};

struct RooflineOptions : BenchOptions {
  int rays = 256, megabytes = 256;
};

int bench_roofline(const RooflineOptions& options) {
  BenchRun run("roofline", "What devices can do at most", options);
  run.head().notes.emplace_back(
      "Reads sum up, copies add a number; both directions count. `read cache` reads 128 KiB again and again. "
      "Operations are multiply-adds, two each, in one chain where each waits for the one before it, and in "
      "eight that do not wait for each other. Each result is compared before its time counts. A launch is "
      "one work-item's, awaited.");
  run.head().notes.emplace_back(
      "The work of a ray is what it needs alone in the scene's tree, near children first, counted by the "
      "host: an fma is two operations; comparisons, whole numbers, and the equations of solids are not "
      "counted. `asked for` are the bytes it reads and writes, from a cache or memory; `at least` is its "
      "share where each node, block and instance comes from memory once. A packet reads a node once for "
      "sixteen rays, so its traffic may lie above the roof.");
  std::vector<TracedScene> scenes;
  for (const std::string& file : options.scenes)
    if (const auto scene = run.compiled(file); scene->info.instance_count > 0)
      scenes.push_back({scene_name(options, file), scene});
    else
      run.head().notes.push_back(file + ": left out: it has nothing that is traced, only marched fields");
  const std::vector<DeviceInfo> devices = run.devices();
  for (const DeviceInfo& device : devices)
    run.measure(std::make_shared<Roofline>(device, static_cast<unsigned>(options.megabytes), scenes,
                                           static_cast<unsigned>(options.rays)));
  return run.publish(true);
}

}  // namespace

void add_bench_roofline(Arguments& bench, Command& chosen) {
  const auto options = std::make_shared<RooflineOptions>();
  Arguments* app =
      add_bench_command(bench, chosen, "roofline", "Bandwidth, operations a second and launches of a device",
                        options, bench_roofline, false);
  value(app, "--megabytes", "N", options->megabytes, "of the buffers that no cache should hold (default 256)")
      ->range(1, 16384);
  value(app, "--rays", "N", options->rays, "camera rays a side (default 256)")->range(1, 16384);
}

}  // namespace sundog
