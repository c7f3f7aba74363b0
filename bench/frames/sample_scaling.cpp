// See sample_scaling.h.
#include "bench/frames/sample_scaling.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "bench/frames/frame_runner.h"
#include "render/film/sampling_report.h"

namespace sundog {
namespace {

constexpr const char* even_family = "even";

SampleFigures figures_of(const FrameRunner& frames, const Image& reference, unsigned samples) {
  const RenderResult& last = frames.last();
  SampleFigures figures;
  figures.rays = frames.rays();
  figures.error = compare_images(frames.image(), reference, visible_error);
  figures.samples =
      last.film.taken.empty() ? samples : sampling_figures(last.film.taken, last.film.done, 0, 1).mean;
  return figures;
}

Spread exactly(double value) { return {value, value, value}; }

}  // namespace

double rays_for_error(const std::vector<SampleFigures>& even, double rms) {
  for (std::size_t i = 0; i + 1 < even.size(); ++i) {
    const double a = even[i].error.rms, b = even[i + 1].error.rms;
    if (!(a > 0) || !(b > 0) || rms > a || rms < b || a == b) continue;
    const double share = std::log(rms / a) / std::log(b / a);
    return even[i].rays * std::pow(even[i + 1].rays / even[i].rays, share);
  }
  return 0;
}

SampleTimes::SampleTimes(SampleScaling plan) : plan_(std::move(plan)), reference_(std::make_shared<Image>()) {
  for (const SampleWay& way : plan_.ways) {
    const auto figures = std::make_shared<SampleFigures>();
    const auto samples = std::make_shared<unsigned>();
    figures_.push_back(figures);
    const auto open = [=, device = plan_.device, compile_with = plan_.compile_with] {
      auto scene = compile_with(way.overrides);
      *samples = scene->info.samples;
      return std::make_shared<FrameRunner>(std::vector{frame_worker(device, scene)}, scene);
    };
    const auto first = [=, reference = reference_](const FrameRunner& frames) {
      *figures = figures_of(frames, *reference, *samples);
    };
    subjects_.push_back(frame_subject(
        fmt::format("{} on {}, {}, {}", plan_.scene, plan_.device.label(), way.family, way.setting),
        {open, first, {}}));
  }
}

void SampleTimes::measure(const MeasureOptions& options) {
  if (options.on_step) options.on_step(fmt::format("the reference of {} samples", plan_.reference), 0);
  const auto draw_reference = [&] {
    const auto scene = plan_.compile_with(
        {fmt::format("/render/samples={}", plan_.reference), "/render/adaptive/threshold=0"});
    RenderOptions stoppable;
    stoppable.stop = options.stop;
    FrameRunner frames({frame_worker(plan_.device, scene)}, scene, stoppable);
    frames.run();
    *reference_ = frames.image();
  };
  if (prepared(subjects_, draw_reference)) sundog::measure(subjects_, options);
}

std::vector<SampleFigures> SampleTimes::even() const {
  std::vector<SampleFigures> all;
  for (std::size_t i = 0; i < subjects_.size(); ++i)
    if (plan_.ways[i].family == even_family && subjects_[i].is_good()) all.push_back(*figures_[i]);
  return all;
}

/// Its rays in per cent of those that even samples need for the same error; 0: unknown.
double SampleTimes::of_even(std::size_t way) const {
  if (plan_.ways[way].family == even_family) return 100;
  const double rays = rays_for_error(even(), figures_[way]->error.rms);
  return rays > 0 ? 100 * figures_[way]->rays / rays : 0;
}

std::vector<Field> SampleTimes::figures(std::size_t way) const {
  const SampleFigures& made = *figures_[way];
  const double seconds = subjects_[way].seconds().median;
  return {{"a sample", "ms", 1e3 * seconds / made.samples},
          {"speed", "Mrays/s", seconds > 0 ? made.rays / 1e6 / seconds : 0},
          {"rms error", "", made.error.rms},
          {"error x sqrt(samples)", "", made.error.rms * std::sqrt(made.samples)},
          {"99 % within", "", made.error.percentile_99},
          {"visibly off", "%",
           100 * static_cast<double>(made.error.over_tolerance) /
               static_cast<double>(std::max<std::uint64_t>(1, made.error.pixels))}};
}

Table SampleTimes::even_table() const {
  Table table{fmt::format("{} on {}: time and error by samples a pixel", plan_.scene, plan_.device.label()),
              {{"samples", ""}, {"time", "ms"}},
              {}};
  for (std::size_t i = 0; i < subjects_.size(); ++i) {
    if (plan_.ways[i].family != even_family) continue;
    std::vector<Field> row{{"samples", "", plan_.ways[i].setting}};
    if (subjects_[i].is_good()) {
      row[0].cell = figures_[i]->samples;
      row.push_back({"time", "ms", milliseconds(subjects_[i])});
      for (const Field& field : figures(i)) row.push_back(field);
    }
    add_row(table, row, subjects_[i]);
  }
  return table;
}

Table SampleTimes::way_table() const {
  Table table{fmt::format("{} on {}: samples where they are needed", plan_.scene, plan_.device.label()),
              {{"samples", ""}, {"a pixel", ""}, {"time", "ms"}},
              {}};
  for (std::size_t i = 0; i < subjects_.size(); ++i) {
    const SampleWay& way = plan_.ways[i];
    if (way.family == even_family) continue;
    std::vector<Field> row{{"samples", "", fmt::format("{}, {}", way.family, way.setting)}};
    if (subjects_[i].is_good()) {
      const double part = of_even(i);
      row.insert(row.end(),
                 {{"a pixel", "", figures_[i]->samples},
                  {"time", "ms", milliseconds(subjects_[i])},
                  {"rays", "millions", figures_[i]->rays / 1e6},
                  {"rms error", "", figures_[i]->error.rms},
                  {"of the rays of even samples at this error", "%", part > 0 ? Cell(part) : Cell()}});
    }
    add_row(table, row, subjects_[i]);
  }
  return table;
}

CurvePlot SampleTimes::even_curves(const std::string& what, const std::string& unit,
                                   const std::function<Spread(std::size_t way)>& value) const {
  Curve curve{plan_.device.label().substr(0, plan_.device.label().find(' ')), {}};
  for (std::size_t i = 0; i < subjects_.size(); ++i)
    if (plan_.ways[i].family == even_family && subjects_[i].is_good())
      curve.points.push_back({figures_[i]->samples, value(i)});
  return {
      fmt::format("{}: {} by samples a pixel", plan_.scene, what), "samples a pixel", unit, {curve}, false};
}

/// Error over what it costs: a curve for each family of ways.
CurvePlot SampleTimes::error_curves(const std::string& what, const std::string& unit,
                                    const std::function<double(std::size_t way)>& cost) const {
  std::vector<Curve> curves;
  for (std::size_t i = 0; i < subjects_.size(); ++i) {
    const std::string& family = plan_.ways[i].family;
    if (curves.empty() || curves.back().name != family) curves.push_back({family, {}});
    const double error = figures_[i]->error.rms;
    if (subjects_[i].is_good() && error > 0 && cost(i) > 0)
      curves.back().points.push_back({cost(i), exactly(error)});
  }
  for (Curve& curve : curves) std::ranges::sort(curve.points, {}, &CurvePoint::x);
  return {fmt::format("{}: error by {}", plan_.scene, what),
          unit,
          "rms error (linear color)",
          curves,
          false,
          true};
}

void SampleTimes::add_to(Report& report) const {
  const auto milliseconds = [&](std::size_t i) { return scaled(subjects_[i].seconds(), 1e3); };
  report.parts.emplace_back(even_table());
  report.parts.emplace_back(even_curves("error", "rms error (linear color)",
                                        [&](std::size_t i) { return exactly(figures_[i]->error.rms); }));
  report.parts.emplace_back(even_curves("time of a frame", "ms", milliseconds));
  report.parts.emplace_back(way_table());
  report.parts.emplace_back(
      error_curves("rays", "millions of rays", [&](std::size_t i) { return figures_[i]->rays / 1e6; }));
  report.parts.emplace_back(
      error_curves("time", "ms a frame", [&](std::size_t i) { return milliseconds(i).median; }));
  for (std::size_t i = 0; i < subjects_.size(); ++i) {
    const SampleWay& way = plan_.ways[i];
    const bool good = subjects_[i].is_good();
    std::vector<Field> more;
    if (good) {
      const double part = of_even(i);
      more = figures(i);
      more.push_back({"rays", "millions", figures_[i]->rays / 1e6});
      more.push_back({"of even rays", "%", part > 0 ? Cell(part) : Cell()});
    }
    add_measured(
        report, subjects_[i],
        {{"scene", "", plan_.scene},
         {"device", "", plan_.device.label()},
         {"way", "", way.family == even_family ? way.family : fmt::format("{}, {}", way.family, way.setting)},
         {"samples", "", good ? Cell(figures_[i]->samples) : Cell()},
         {"reference samples", "", static_cast<double>(plan_.reference)}},
        more);
  }
}

}  // namespace sundog
