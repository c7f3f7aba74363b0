// See sample_ways.h.
#include "bench/frames/sample_ways.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "render/film/sampling_report.h"
#include "render/session/render_session.h"

namespace sundog {
namespace {

double traced_rays(const RenderResult& result) {
  double rays = static_cast<double>(result.surfaces_seen);
  for (const int kind : {COUNT_PRIMARY, COUNT_REFLECTION, COUNT_REFRACTION, COUNT_SHADOW})
    rays += static_cast<double>(result.counts[static_cast<std::size_t>(kind)]);
  return rays;
}

double of_even(const WayTime& time) { return time.even_rays > 0 ? 100 * time.time.rays / time.even_rays : 0; }

/// Error over what it costs: a curve of even samples and one for each family of ways.
CurvePlot error_curves(const SampleWays& plan, const std::vector<SampleTime>& even,
                       const std::vector<WayTime>& times, const std::string& what, const std::string& unit,
                       const std::function<double(const SampleTime&)>& cost) {
  std::vector<Curve> curves{{"even", {}}};
  const auto add = [&](Curve& curve, const SampleTime& time) {
    const double error = time.error.rms;
    if (time.problem.empty() && error > 0 && cost(time) > 0)
      curve.points.push_back({cost(time), {error, error, error}});
  };
  for (const SampleTime& time : even) add(curves[0], time);
  for (const WayTime& time : times) {
    if (curves.back().name != time.way.family) curves.push_back({time.way.family, {}});
    add(curves.back(), time.time);
  }
  for (Curve& curve : curves) std::ranges::sort(curve.points, {}, &CurvePoint::x);
  return {fmt::format("{}: error by {}", plan.even.scene, what),
          unit,
          "rms error (linear color)",
          curves,
          false,
          true};
}

}  // namespace

double rays_for_error(const std::vector<SampleTime>& even, double rms) {
  for (std::size_t i = 0; i + 1 < even.size(); ++i) {
    const double a = even[i].error.rms, b = even[i + 1].error.rms;
    if (!(a > 0) || !(b > 0) || rms > a || rms < b || a == b) continue;
    const double share = std::log(rms / a) / std::log(b / a);
    return even[i].rays * std::pow(even[i + 1].rays / even[i].rays, share);
  }
  return 0;
}

std::vector<WayTime> measure_ways(const SampleWays& plan, const std::vector<SampleTime>& even,
                                  const std::function<void(const std::string&)>& on_step) {
  RenderSession session({plan.even.device});
  using Scene = std::shared_ptr<const CompiledScene>;
  const auto compiled = [&](const std::vector<std::string>& overrides) {
    return std::make_shared<const CompiledScene>(plan.compile_with(overrides));
  };
  const std::string& name = plan.even.scene;
  on_step(fmt::format("{}, the reference of {} samples", name, plan.even.reference));
  const Image right = session
                          .render(compiled({fmt::format("/render/samples={}", plan.even.reference),
                                            "/render/adaptive/threshold=0"}))
                          .image;
  std::vector<Scene> scenes;
  std::vector<WayTime> times;
  std::vector<std::vector<double>> seconds(plan.ways.size());
  for (const SampleWay& way : plan.ways) {
    on_step(fmt::format("{}, {}, {}", name, way.family, way.setting));
    scenes.push_back(compiled(way.overrides));
    const RenderResult result = session.render(scenes.back());
    WayTime time{way, {}, 0, 0};
    time.time.rays = traced_rays(result);
    time.time.error = compare_images(result.image, right, visible_error);
    time.samples_a_pixel = sampling_figures(result.taken, result.film.done, 0, 1).mean;
    time.even_rays = rays_for_error(even, time.time.error.rms);
    times.push_back(std::move(time));
  }
  for (int run = 0; run < plan.even.repeat; ++run)
    for (std::size_t i = 0; i < scenes.size(); ++i) {
      const RenderTimes spent = session.render(scenes[i]).times;
      seconds[i].push_back(spent.render + spent.readback);
    }
  for (std::size_t i = 0; i < times.size(); ++i) times[i].time.seconds = spread(seconds[i]);
  return times;
}

void add_way_tables(Report& report, const SampleWays& plan, const std::vector<SampleTime>& even,
                    const std::vector<WayTime>& times) {
  Table table{
      fmt::format("{} on {}: samples where they are needed", plan.even.scene, plan.even.device.label()),
      {{"samples", ""},
       {"a pixel", ""},
       {"time", "ms"},
       {"rays", "millions"},
       {"rms error", ""},
       {"of the rays of even samples at this error", "%"}},
      {}};
  for (const WayTime& time : times) {
    const std::string name = fmt::format("{}, {}", time.way.family, time.way.setting);
    std::vector<Cell> row{name, time.samples_a_pixel, scaled(time.time.seconds, 1e3), time.time.rays / 1e6,
                          time.time.error.rms};
    if (time.even_rays > 0) row.emplace_back(of_even(time));
    row.resize(table.columns.size());
    table.rows.push_back(std::move(row));
    add_measurement(report, plan.even, name, time.time, time.samples_a_pixel, of_even(time));
  }
  report.parts.emplace_back(std::move(table));
  report.parts.emplace_back(error_curves(plan, even, times, "rays", "millions of rays",
                                         [](const SampleTime& time) { return time.rays / 1e6; }));
  report.parts.emplace_back(error_curves(plan, even, times, "time", "ms a frame",
                                         [](const SampleTime& time) { return 1e3 * time.seconds.median; }));
}

}  // namespace sundog
