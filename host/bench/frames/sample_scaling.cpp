// See sample_scaling.h.
#include "bench/frames/sample_scaling.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>

#include "bench/frames/frame_runner.h"

namespace sundog {
namespace {

/// A scene for one number of samples, ready to be rendered again and again.
struct SampleRunner {
  CompiledScene scene;
  FrameRunner frames;
  Image expected;
  std::vector<double> seconds;
  SampleTime result;

  SampleRunner(const DeviceInfo& device, CompiledScene scene_)
      : scene(std::move(scene_)), frames(device, scene) {}

  void warm_up(const Image& reference) {
    frames.run();
    expected = frames.image();
    result.error = compare_images(expected, reference, visible_error);
    for (const int kind : {COUNT_PRIMARY, COUNT_REFLECTION, COUNT_REFRACTION, COUNT_SHADOW})
      result.rays += static_cast<double>(frames.counts()[static_cast<std::size_t>(kind)]);
  }

  void time() {
    seconds.push_back(frames.run());
    const Image image = frames.image();
    if (std::memcmp(image.data.data(), expected.data.data(), image.data.size() * sizeof(float)) != 0)
      result.problem = "the image changed from one run to the next";
  }
};

Spread milliseconds(const Spread& seconds) {
  return {1e3 * seconds.median, 1e3 * seconds.min, 1e3 * seconds.max};
}

std::vector<Cell> figures(const SampleTime& time, double samples) {
  return {milliseconds(time.seconds),
          1e3 * time.seconds.median / samples,
          time.seconds.median > 0 ? time.rays / 1e6 / time.seconds.median : 0,
          time.error.rms,
          time.error.rms * std::sqrt(samples),
          time.error.percentile_99,
          100 * static_cast<double>(time.error.over_tolerance) /
              static_cast<double>(std::max<std::uint64_t>(1, time.error.pixels))};
}

const std::vector<Column> figure_columns = {{"time", "ms"},
                                            {"a sample", "ms"},
                                            {"speed", "Mrays/s"},
                                            {"rms error", ""},
                                            {"error x sqrt(samples)", ""},
                                            {"99 % within", ""},
                                            {"visibly off", "%"}};

/// Curves of one value over the samples, for the device of the plan.
CurvePlot curves(const SampleScaling& plan, const std::vector<SampleTime>& times, const std::string& what,
                 const std::string& unit, const std::function<Spread(const SampleTime&)>& value) {
  Curve curve{plan.device.label().substr(0, plan.device.label().find(' ')), {}};
  for (const SampleTime& time : times)
    if (time.problem.empty()) curve.points.push_back({static_cast<double>(time.samples), value(time)});
  return {
      fmt::format("{}: {} by samples a pixel", plan.scene, what), "samples a pixel", unit, {curve}, false};
}

}  // namespace

std::vector<SampleTime> measure_samples(const SampleScaling& plan,
                                        const std::function<void(const std::string&)>& on_step) {
  on_step(fmt::format("{}, the reference of {} samples", plan.scene, plan.reference));
  Image reference;
  {
    SampleRunner runner(plan.device, plan.compile_for(plan.reference));
    runner.frames.run();
    reference = runner.frames.image();
  }
  std::vector<std::unique_ptr<SampleRunner>> runners;
  for (const int samples : plan.counts) {
    on_step(fmt::format("{}, {} samples", plan.scene, samples));
    runners.push_back(std::make_unique<SampleRunner>(plan.device, plan.compile_for(samples)));
    runners.back()->result.samples = samples;
    runners.back()->warm_up(reference);
  }
  for (int i = 0; i < plan.repeat; ++i) {
    on_step(fmt::format("{}, run {} of {}", plan.scene, i + 1, plan.repeat));
    for (const auto& runner : runners) runner->time();
  }
  std::vector<SampleTime> times;
  for (const auto& runner : runners) {
    runner->result.seconds = spread(runner->seconds);
    times.push_back(runner->result);
  }
  return times;
}

void add_measurement(Report& report, const SampleScaling& plan, const std::string& way,
                     const SampleTime& time, double samples, double of_even) {
  Table& measured = report.measurements;
  if (measured.columns.empty()) {
    measured.columns = {
        {"scene", ""}, {"device", ""}, {"way", ""}, {"samples", ""}, {"reference samples", ""}, {"runs", ""}};
    measured.columns.insert(measured.columns.end(), figure_columns.begin(), figure_columns.end());
    measured.columns.insert(measured.columns.end(),
                            {{"rays", "millions"}, {"of even rays", "%"}, {"problem", ""}});
  }
  std::vector<Cell> row{plan.scene,
                        plan.device.label(),
                        way,
                        samples,
                        static_cast<double>(plan.reference),
                        static_cast<double>(plan.repeat)};
  if (time.problem.empty()) {
    for (const Cell& cell : figures(time, samples)) row.push_back(cell);
    row.emplace_back(time.rays / 1e6);
    if (of_even > 0) row.emplace_back(of_even);
  }
  row.resize(measured.columns.size());
  if (!time.problem.empty()) row.back() = time.problem;
  measured.rows.push_back(std::move(row));
}

void add_sample_tables(Report& report, const SampleScaling& plan, const std::vector<SampleTime>& times) {
  Table table{fmt::format("{} on {}: time and error by samples a pixel", plan.scene, plan.device.label()),
              {{"samples", ""}},
              {}};
  table.columns.insert(table.columns.end(), figure_columns.begin(), figure_columns.end());
  const bool sound = std::ranges::all_of(times, [](const SampleTime& time) { return time.problem.empty(); });
  if (!sound) table.columns.push_back({"problem", ""});
  for (const SampleTime& time : times) {
    std::vector<Cell> row{static_cast<double>(time.samples)};
    if (time.problem.empty())
      for (const Cell& cell : figures(time, time.samples)) row.push_back(cell);
    row.resize(table.columns.size());
    if (!time.problem.empty()) row.back() = time.problem;
    table.rows.push_back(std::move(row));
    add_measurement(report, plan, "even", time, time.samples, 100);
  }
  report.parts.emplace_back(std::move(table));
  report.parts.emplace_back(
      curves(plan, times, "error", "rms error (linear color)",
             [](const SampleTime& time) { return Spread{time.error.rms, time.error.rms, time.error.rms}; }));
  report.parts.emplace_back(curves(plan, times, "time of a frame", "ms",
                                   [](const SampleTime& time) { return milliseconds(time.seconds); }));
}

}  // namespace sundog
