// See sample_ways.h.
#include "bench/frames/sample_ways.h"

#include <fmt/format.h>

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
  RenderSession session({plan.device});
  using Scene = std::shared_ptr<const CompiledScene>;
  const auto compiled = [&](const std::vector<std::string>& overrides) {
    return std::make_shared<const CompiledScene>(plan.compile_with(overrides));
  };
  on_step(fmt::format("{}, the reference of {} samples", plan.scene, plan.reference));
  const Image right = session
                          .render(compiled({fmt::format("/render/samples={}", plan.reference),
                                            "/render/adaptive/threshold=0"}))
                          .image;
  std::vector<Scene> scenes;
  std::vector<WayTime> times;
  std::vector<std::vector<double>> seconds(plan.ways.size());
  for (const SampleWay& way : plan.ways) {
    on_step(fmt::format("{}, {}", plan.scene, way.name));
    scenes.push_back(compiled(way.overrides));
    const RenderResult result = session.render(scenes.back());
    WayTime time;
    time.name = way.name;
    time.rays = traced_rays(result);
    time.samples_a_pixel = sampling_figures(result.taken, result.film.done, 0, 1).mean;
    time.rms = compare_images(result.image, right, 0).rms;
    time.even_rays = rays_for_error(even, time.rms);
    times.push_back(time);
  }
  for (int run = 0; run < plan.repeat; ++run)
    for (std::size_t i = 0; i < scenes.size(); ++i) {
      const RenderTimes spent = session.render(scenes[i]).times;
      seconds[i].push_back(spent.render + spent.readback);
    }
  for (std::size_t i = 0; i < times.size(); ++i) times[i].seconds = spread(seconds[i]);
  return times;
}

void add_way_table(Report& report, const SampleWays& plan, const std::vector<WayTime>& times) {
  Table table{fmt::format("{} on {}: samples where they are needed", plan.scene, plan.device.label()),
              {{"samples", ""},
               {"a pixel", ""},
               {"time", "ms"},
               {"rays", "millions"},
               {"rms error", ""},
               {"of the rays of even samples at this error", "%"}},
              {}};
  for (const WayTime& time : times) {
    const Spread ms{1e3 * time.seconds.median, 1e3 * time.seconds.min, 1e3 * time.seconds.max};
    std::vector<Cell> row{time.name, time.samples_a_pixel, ms, time.rays / 1e6, time.rms};
    if (time.even_rays > 0) row.push_back(100 * time.rays / time.even_rays);
    row.resize(table.columns.size());
    table.rows.push_back(std::move(row));
  }
  report.parts.emplace_back(std::move(table));
}

}  // namespace sundog
