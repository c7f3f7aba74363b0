// See quality.h.
#include "bench/quality/quality.h"

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <memory>

#include "base/error.h"
#include "base/image_compare.h"
#include "bench/frames/frame_runner.h"
#include "bench/quality/perceived_difference.h"

namespace sundog {
namespace {

/// A scene for one way and number of samples, ready to be rendered again and again.
struct QualityRunner {
  CompiledScene scene;
  FrameRunner frames;
  Image first;
  std::vector<double> seconds;
  QualityTime result;

  QualityRunner(const DeviceInfo& device, CompiledScene scene_)
      : scene(std::move(scene_)), frames(device, scene) {}

  void warm_up(const QualityPlan& plan) {
    frames.run();
    first = frames.image();
    if (first.width != plan.reference.width || first.height != plan.reference.height)
      throw UsageError(fmt::format("{}: its picture has {}x{} pixels, the reference {}x{}", plan.scene,
                                   first.width, first.height, plan.reference.width, plan.reference.height));
    result.rms = compare_images(first, plan.reference, 0).rms;
    result.perceived = perceived_difference(first, plan.reference);
  }

  void time() {
    seconds.push_back(frames.run());
    const Image image = frames.image();
    if (std::memcmp(image.data.data(), first.data.data(), image.data.size() * sizeof(float)) != 0)
      result.problem = "the image changed from one run to the next";
  }
};

std::string name_of(const QualityWay& way) { return way.integrator + ", " + way.sampler; }

Spread in_milliseconds(const Spread& seconds) {
  return {1e3 * seconds.median, 1e3 * seconds.min, 1e3 * seconds.max};
}

/// The times of each way, in their order.
std::vector<std::vector<QualityTime>> by_way(const QualityPlan& plan, const std::vector<QualityTime>& times) {
  std::vector<std::vector<QualityTime>> groups(plan.ways.size());
  for (std::size_t i = 0; i < times.size(); ++i) groups[i / plan.counts.size()].push_back(times[i]);
  return groups;
}

CurvePlot curves(const QualityPlan& plan, const std::vector<std::vector<QualityTime>>& groups,
                 const std::string& what, const std::function<double(const QualityTime&)>& error_of) {
  CurvePlot plot{
      fmt::format("{}: {} by time", plan.scene, what), "time of a frame, ms", what, {}, false, true};
  for (const auto& group : groups) {
    Curve curve{name_of(group.front().way), {}};
    for (const QualityTime& time : group)
      if (time.problem.empty() && error_of(time) > 0 && time.seconds.median > 0)
        curve.points.push_back({1e3 * time.seconds.median, Cell(error_of(time)).spread});
    plot.curves.push_back(std::move(curve));
  }
  return plot;
}

Table goal_table(const QualityPlan& plan, const std::vector<std::vector<QualityTime>>& groups) {
  Table table{fmt::format("{} on {}: time to an error of {:g}", plan.scene, plan.device.label(), plan.goal),
              {{"integrator", ""}, {"sampler", ""}, {"time", "ms"}},
              {}};
  for (const auto& group : groups) {
    const double seconds = seconds_to(group, plan.goal);
    const QualityWay& way = group.front().way;
    table.rows.push_back({way.integrator, way.sampler, seconds > 0 ? Cell(1e3 * seconds) : Cell()});
  }
  return table;
}

}  // namespace

std::vector<QualityTime> measure_quality(const QualityPlan& plan,
                                         const std::function<void(const std::string&)>& on_step) {
  std::vector<std::unique_ptr<QualityRunner>> runners;
  for (const QualityWay& way : plan.ways)
    for (const int samples : plan.counts) {
      on_step(fmt::format("{}, {}, {} samples", plan.scene, name_of(way), samples));
      runners.push_back(std::make_unique<QualityRunner>(plan.device, plan.compile_for(way, samples)));
      runners.back()->result.way = way;
      runners.back()->result.samples = samples;
      runners.back()->warm_up(plan);
    }
  for (int i = 0; i < plan.repeat; ++i) {
    on_step(fmt::format("{}, run {} of {}", plan.scene, i + 1, plan.repeat));
    for (const auto& runner : runners) runner->time();
  }
  std::vector<QualityTime> times;
  for (const auto& runner : runners) {
    runner->result.seconds = spread(runner->seconds);
    times.push_back(runner->result);
  }
  return times;
}

double seconds_to(const std::vector<QualityTime>& of_one_way, double goal) {
  for (std::size_t i = 0; i + 1 < of_one_way.size(); ++i) {
    const QualityTime &a = of_one_way[i], &b = of_one_way[i + 1];
    if (!(b.rms > 0) || goal > a.rms || goal < b.rms || a.rms == b.rms) continue;
    const double share = std::log(goal / a.rms) / std::log(b.rms / a.rms);
    return a.seconds.median * std::pow(b.seconds.median / a.seconds.median, share);
  }
  return 0;
}

void add_quality(Report& report, const QualityPlan& plan, const std::vector<QualityTime>& times) {
  const std::vector<Column> columns = {{"integrator", ""}, {"sampler", ""},   {"samples", ""},
                                       {"time", "ms"},     {"rms error", ""}, {"perceived difference", ""},
                                       {"problem", ""}};
  Table table{fmt::format("{} on {}: error by time", plan.scene, plan.device.label()), columns, {}};
  Table& measured = report.measurements;
  if (measured.columns.empty()) {
    measured.columns = {{"scene", ""}, {"device", ""}, {"runs", ""}};
    measured.columns.insert(measured.columns.end(), columns.begin(), columns.end());
  }
  for (const QualityTime& time : times) {
    std::vector<Cell> row{time.way.integrator, time.way.sampler, static_cast<double>(time.samples)};
    if (time.problem.empty())
      row.insert(row.end(), {in_milliseconds(time.seconds), time.rms, time.perceived, Cell()});
    else
      row.insert(row.end(), {Cell(), Cell(), Cell(), time.problem});
    std::vector<Cell> tidy{plan.scene, plan.device.label(), static_cast<double>(plan.repeat)};
    tidy.insert(tidy.end(), row.begin(), row.end());
    table.rows.push_back(std::move(row));
    measured.rows.push_back(std::move(tidy));
  }
  const std::vector<std::vector<QualityTime>> groups = by_way(plan, times);
  report.parts.emplace_back(std::move(table));
  report.parts.emplace_back(goal_table(plan, groups));
  report.parts.emplace_back(curves(plan, groups, "rms error", &QualityTime::rms));
  report.parts.emplace_back(curves(plan, groups, "perceived difference", &QualityTime::perceived));
}

}  // namespace sundog
