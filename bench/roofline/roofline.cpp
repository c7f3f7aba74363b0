// See roofline.h.
#include "bench/roofline/roofline.h"

#include <fmt/format.h>

#include <algorithm>

#include "bench/roofline/ray_work.h"
#include "render/device/kernel_config.h"

namespace sundog {
namespace {

struct Roof {
  std::string name;
  Spread bandwidth;
};

/// Up along the bandwidth to the peak, then level, from `low` to `high` operations a byte.
Curve roof_curve(const Roof& roof, const Spread& peak, double low, double high) {
  const double ridge = peak.median / roof.bandwidth.median;
  Curve curve{roof.name, {}};
  if (low < ridge) curve.points.push_back({low, scaled(roof.bandwidth, low)});
  curve.points.push_back({ridge, peak});
  if (high > ridge) curve.points.push_back({high, peak});
  return curve;
}

/// Roofs about the points, which are curves of one point.
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

}  // namespace

Roofline::Roofline(const DeviceInfo& device, unsigned megabytes, const std::vector<NamedScene>& scenes,
                   unsigned rays)
    : info_(device), peaks_(device, megabytes) {
  for (const NamedScene& scene : scenes)
    traced_.push_back({scene, std::make_shared<RayTimes>(scene.name, scene.scene, device, rays,
                                                         std::vector<std::string>{})});
}

void Roofline::measure(const MeasureOptions& options) {
  peaks_.measure(options);
  for (const Traced& traced : traced_)
    if (!options.is_stopped()) traced.times->measure(options);
}

void Roofline::add_scene(Report& report, const Traced& traced) const {
  const bool compact = traces_compact(*traced.scene.scene, info_);
  Table table{fmt::format("{} on {}: work of a ray", traced.scene.name, info_.label()), {}, {}};
  std::vector<Curve> points;
  const auto memory = peaks_.best("read memory"), cache = peaks_.best("read cache"),
             peak = peaks_.best("float");
  for (const RayTimes::Timed& timed : traced.times->timed()) {
    const RayWork work = ray_work(*traced.scene.scene, *timed.set, compact);
    const Spread operations = scaled(timed.rate, 1e-3 * work.operations);
    std::vector<Field> shown{{"kind", "", timed.set->kind},
                             {"nodes", "", work.nodes},
                             {"blocks", "", work.blocks},
                             {"work", "op", work.operations},
                             {"asked for", "B", work.bytes},
                             {"at least", "B", work.least_bytes},
                             {"intensity", "op/B", work.intensity()},
                             {"rate", "Gop/s", operations},
                             {"traffic", "GB/s", scaled(timed.rate, 1e-3 * work.bytes)}};
    if (cache && memory && peak) {
      // Bytes that must come from memory come at its speed, those asked for at that of the cache.
      const double bound = std::min({peak->median, cache->median * work.intensity(),
                                     memory->median * work.operations / work.least_bytes});
      shown.push_back({"of the roof", "%", 100 * operations.median / bound});
    }
    add_row(table, shown);
    std::vector<Field> row{{"scene", "", traced.scene.name}, {"device", "", info_.label()}};
    row.insert(row.end(), shown.begin(), shown.end());
    row.push_back({"rays", "Mrays/s", timed.rate});
    add_row(report.measurements, row);
    points.push_back({timed.set->kind, {{work.intensity(), operations}}});
  }
  if (table.rows.empty()) return;
  report.parts.emplace_back(std::move(table));
  if (cache && memory && peak)
    report.parts.emplace_back(
        plot_of(fmt::format("{} under the roofline of {}", traced.scene.name, info_.label()),
                {{"cache", *cache}, {"memory", *memory}}, *peak, points));
}

void Roofline::add_to(Report& report) const {
  peaks_.add_to(report);
  const auto memory = peaks_.best("read memory"), cache = peaks_.best("read cache"),
             peak = peaks_.best("float");
  if (traced_.empty() && memory && cache && peak)
    report.parts.emplace_back(plot_of(fmt::format("Roofline of {}", info_.label()),
                                      {{"cache", *cache}, {"memory", *memory}}, *peak, {}));
  for (const Traced& traced : traced_) {
    Report rays;
    traced.times->add_to(rays);
    report.ways.insert(report.ways.end(), rays.ways.begin(), rays.ways.end());
    add_scene(report, traced);
  }
}

}  // namespace sundog
