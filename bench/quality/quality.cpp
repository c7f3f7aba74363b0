// See quality.h.
#include "bench/quality/quality.h"

#include <fmt/format.h>

#include <cmath>
#include <memory>

#include "base/error.h"
#include "base/image_compare.h"
#include "bench/frames/frame_runner.h"
#include "bench/quality/perceived_difference.h"

namespace sundog {
namespace {

std::string name_of(const QualityWay& way) { return way.integrator + ", " + way.sampler; }

/// By the first picture of a way.
void compare(QualityTime& time, const QualityPlan& plan, const Image& image) {
  if (image.width != plan.reference.width || image.height != plan.reference.height)
    throw UsageError(fmt::format("{}: its picture has {}x{} pixels, the reference {}x{}", plan.scene,
                                 image.width, image.height, plan.reference.width, plan.reference.height));
  time.rms = compare_images(image, plan.reference, 0).rms;
  time.perceived = perceived_difference(image, plan.reference);
}

}  // namespace

double seconds_to(const std::vector<QualityTime>& of_one_way, double goal) {
  for (std::size_t i = 0; i + 1 < of_one_way.size(); ++i) {
    const QualityTime &a = of_one_way[i], &b = of_one_way[i + 1];
    if (!(b.rms > 0) || goal > a.rms || goal < b.rms || a.rms == b.rms) continue;
    const double share = std::log(goal / a.rms) / std::log(b.rms / a.rms);
    return a.seconds.median * std::pow(b.seconds.median / a.seconds.median, share);
  }
  return 0;
}

QualityTimes::QualityTimes(QualityPlan plan) : plan_(std::move(plan)) {
  for (const QualityWay& way : plan_.ways)
    for (const int samples : plan_.counts) {
      const auto time = std::make_shared<QualityTime>();
      time->way = way;
      time->samples = samples;
      times_.push_back(time);
      const auto open = [this, way, samples] {
        auto scene = plan_.compile_for(way, samples);
        return std::make_shared<FrameRunner>(std::vector{frame_worker(plan_.device, scene)}, scene);
      };
      const auto first = [this, time](const FrameRunner& frames) { compare(*time, plan_, frames.image()); };
      subjects_.push_back(frame_subject(
          fmt::format("{} on {}, {}, {} samples", plan_.scene, plan_.device.label(), name_of(way), samples),
          {open, first, {}}));
    }
}

void QualityTimes::measure(const MeasureOptions& options) { sundog::measure(subjects_, options); }

/// The good times of each way, in their order.
std::vector<std::vector<QualityTime>> QualityTimes::by_way() const {
  std::vector<std::vector<QualityTime>> groups(plan_.ways.size());
  for (std::size_t i = 0; i < times_.size(); ++i) {
    if (!subjects_[i].is_good()) continue;
    QualityTime time = *times_[i];
    time.seconds = subjects_[i].seconds();
    groups[i / plan_.counts.size()].push_back(std::move(time));
  }
  return groups;
}

CurvePlot QualityTimes::curves(const std::string& what,
                               const std::function<double(const QualityTime&)>& error_of) const {
  CurvePlot plot{
      fmt::format("{}: {} by time", plan_.scene, what), "time of a frame, ms", what, {}, false, true};
  for (const auto& group : by_way()) {
    if (group.empty()) continue;
    Curve curve{name_of(group.front().way), {}};
    for (const QualityTime& time : group)
      if (error_of(time) > 0 && time.seconds.median > 0)
        curve.points.push_back({1e3 * time.seconds.median, Cell(error_of(time)).spread});
    plot.curves.push_back(std::move(curve));
  }
  return plot;
}

Table QualityTimes::goal_table() const {
  Table table{
      fmt::format("{} on {}: time to an error of {:g}", plan_.scene, plan_.device.label(), plan_.goal),
      {{"integrator", ""}, {"sampler", ""}, {"time", "ms"}},
      {}};
  for (const auto& group : by_way()) {
    if (group.empty()) continue;
    const double seconds = seconds_to(group, plan_.goal);
    const QualityWay& way = group.front().way;
    table.rows.push_back({way.integrator, way.sampler, seconds > 0 ? Cell(1e3 * seconds) : Cell()});
  }
  return table;
}

void QualityTimes::add_to(Report& report) const {
  Table table{fmt::format("{} on {}: error by time", plan_.scene, plan_.device.label()), {}, {}};
  for (std::size_t i = 0; i < times_.size(); ++i) {
    const QualityTime& time = *times_[i];
    const bool good = subjects_[i].is_good();
    std::vector<Field> shown{{"integrator", "", time.way.integrator},
                             {"sampler", "", time.way.sampler},
                             {"samples", "", static_cast<double>(time.samples)}};
    std::vector<Field> row{{"scene", "", plan_.scene}, {"device", "", plan_.device.label()}};
    row.insert(row.end(), shown.begin(), shown.end());
    const std::vector<Field> errors{{"rms error", "", good ? Cell(time.rms) : Cell()},
                                    {"perceived difference", "", good ? Cell(time.perceived) : Cell()}};
    shown.push_back({"time", "ms", milliseconds(subjects_[i])});
    shown.insert(shown.end(), errors.begin(), errors.end());
    add_row(table, shown, subjects_[i]);
    add_measured(report, subjects_[i], row, errors);
  }
  report.parts.emplace_back(std::move(table));
  report.parts.emplace_back(goal_table());
  report.parts.emplace_back(curves("rms error", &QualityTime::rms));
  report.parts.emplace_back(curves("perceived difference", &QualityTime::perceived));
}

}  // namespace sundog
