// `sundog bench quality`: error against a reference, by time, of samplers and integrators.
#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "app/options/option_helpers.h"
#include "app/options/option_values.h"
#include "app/render/output_files.h"
#include "base/error.h"
#include "base/image_compare.h"
#include "base/image_io.h"
#include "bench/commands/bench_run.h"
#include "bench/frames/frame_runner.h"
#include "bench/quality/perceived_difference.h"
#include "bench/report/machine.h"
#include "bench/report/report.h"
#include "bench/runs/measure.h"
#include "compile/compiled_scene.h"
#include "device/devices.h"

namespace sundog {
namespace {

/// One way to render the scene.
struct QualityWay {
  std::string integrator, sampler;
};

struct QualityPlan {
  std::string scene;
  std::function<std::shared_ptr<const CompiledScene>(const QualityWay& way, int samples)> compile_for;
  DeviceInfo device;
  std::vector<QualityWay> ways;
  std::vector<int> counts;  // samples a pixel, ascending
  Image reference;
  double goal = 0.02;  // root mean square error; ways are compared by the time to reach it
};

/// A way's figures with one number of samples.
struct QualityTime {
  QualityWay way;
  int samples = 0;
  Spread seconds;
  double rms = 0, perceived = 0;  // against the reference
};

std::string name_of(const QualityWay& way) { return way.integrator + ", " + way.sampler; }

/// Sets the errors of a way's first picture. Throws UsageError if its size is not the reference's.
void compare(QualityTime& time, const QualityPlan& plan, const Image& image) {
  if (image.width != plan.reference.width || image.height != plan.reference.height)
    throw UsageError(fmt::format("{}: its picture has {}x{} pixels, the reference {}x{}", plan.scene,
                                 image.width, image.height, plan.reference.width, plan.reference.height));
  time.rms = compare_images(image, plan.reference, 0).rms;
  time.perceived = perceived_difference(image, plan.reference);
}

class QualityTimes {
 public:
  explicit QualityTimes(QualityPlan plan) : plan_(std::move(plan)) {
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
        subjects_.push_back(frame_subject(fmt::format("{}, {}, {} samples", place(), name_of(way), samples),
                                          {open, first, {}, {plan_.device}}));
      }
  }

  /// Times frames of all ways and counts in turn. Throws UsageError if the scene's picture and the reference
  /// differ in size.
  void measure(const MeasureOptions& options) { sundog::measure(subjects_, options); }
  /// Adds tables, curves and measurements.
  void add_to(Report& report) const {
    Table table{place() + ": error by time", {}, {}};
    for (std::size_t i = 0; i < times_.size(); ++i) {
      const QualityTime& time = *times_[i];
      const bool good = subjects_[i].is_good();
      std::vector<Field> shown{{"integrator", "", time.way.integrator},
                               {"sampler", "", time.way.sampler},
                               {"samples", "", static_cast<double>(time.samples)}};
      std::vector<Field> row{{"scene", "", plan_.scene}, {"device", "", device_title(plan_.device)}};
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

 private:
  std::string place() const { return fmt::format("{} on {}", plan_.scene, device_title(plan_.device)); }

  /// The good times of each way, in their order.
  std::vector<std::vector<QualityTime>> by_way() const {
    std::vector<std::vector<QualityTime>> groups(plan_.ways.size());
    for (std::size_t i = 0; i < times_.size(); ++i) {
      if (!subjects_[i].is_good()) continue;
      QualityTime time = *times_[i];
      time.seconds = subjects_[i].seconds();
      groups[i / plan_.counts.size()].push_back(std::move(time));
    }
    return groups;
  }

  CurvePlot curves(const std::string& what, const std::function<double(const QualityTime&)>& error_of) const {
    CurvePlot plot{
        fmt::format("{}: {} by time", place(), what), "time of a frame, ms", what, {}, false, true};
    for (const auto& group : by_way()) {
      if (group.empty()) continue;
      Curve curve{name_of(group.front().way), {}};
      for (const QualityTime& time : group)
        if (error_of(time) > 0 && time.seconds.median > 0)
          curve.points.push_back({1e3 * time.seconds.median, Cell(error_of(time)).spread,
                                  median_interval(scaled(time.seconds, 1e3))});
      plot.curves.push_back(std::move(curve));
    }
    return plot;
  }

  Table goal_table() const {
    Table table{fmt::format("{}: time to an error of {:g}", place(), plan_.goal),
                {{"integrator", ""}, {"sampler", ""}, {"time", "ms"}},
                {}};
    for (const auto& group : by_way()) {
      if (group.empty()) continue;
      std::vector<ErrorCost> measured;
      for (const QualityTime& time : group) measured.push_back({time.rms, time.seconds.median});
      const double seconds = cost_of_error(measured, plan_.goal);
      const QualityWay& way = group.front().way;
      table.rows.push_back({way.integrator, way.sampler, seconds > 0 ? Cell(1e3 * seconds) : Cell()});
    }
    return table;
  }

  QualityPlan plan_;
  std::vector<std::shared_ptr<QualityTime>> times_;  // for each way, all counts
  std::vector<Subject> subjects_;
};

struct QualityOptions : BenchOptions {
  std::string reference, integrators, samplers = "auto,sobol,independent", counts = "1,4,16,64",
                                      goal = "0.02";
};

/// Every integrator with every sampler; without --integrators, the scene's integrator.
std::vector<QualityWay> quality_ways(const QualityOptions& options, const std::string& file) {
  std::vector<std::string> integrators = split_names(options.integrators);
  if (integrators.empty()) integrators.push_back(bench_description(file, options).render.integrator);
  const std::vector<std::string> samplers = split_names(options.samplers);
  if (samplers.empty()) throw UsageError("--samplers: wanted names with commas between, such as auto,sobol");
  std::vector<QualityWay> ways;
  for (const std::string& integrator : integrators)
    for (const std::string& sampler : samplers) ways.push_back({integrator, sampler});
  return ways;
}

int bench_quality(const QualityOptions& options) {
  QualityPlan plan;
  plan.counts = parse_list("--counts", options.counts, 1, 65536);
  plan.goal = parse_real("--goal", options.goal, 1e-9, 1e9);
  check_output_files(options.all(), {options.reference});
  plan.reference = read_image(options.reference);
  if (plan.reference.channels < 3)
    throw UsageError(fmt::format("{}: wanted a picture with colours", options.reference));
  BenchRun run("quality", "Error by time", options);
  run.head().times_frames = true;
  run.head().facts.emplace_back("reference", options.reference);
  run.head().notes.emplace_back(
      "Medians of frames after one to warm up; ways and counts take turns, and the image of each "
      "run was compared to the bit before its time counted. The error is the root mean square "
      "difference from the reference, in linear color. The perceived difference is the mean of "
      "FLIP (Andersson and others 2020) at 67 pixels a degree, where values above 1 count as 1.");
  const std::vector<DeviceInfo> devices = run.devices();
  for (const std::string& file : options.scenes)
    for (const DeviceInfo& device : devices) {
      plan.scene = scene_name(options, file);
      plan.device = device;
      plan.ways = quality_ways(options, file);
      plan.compile_for = [&run, file](const QualityWay& way, int samples) {
        return run.compiled(file, {fmt::format("/render/samples={}", samples), "/render/adaptive/threshold=0",
                                   fmt::format("/render/integrator={}", way.integrator),
                                   fmt::format("/render/sampler={}", way.sampler)});
      };
      run.measure(std::make_shared<QualityTimes>(plan));
    }
  return run.publish();
}

}  // namespace

void add_bench_quality(Arguments& bench, Command& chosen) {
  const auto options = std::make_shared<QualityOptions>();
  Arguments* app = add_bench_command(bench, chosen, "quality", "Error by time of samplers and integrators",
                                     options, bench_quality);
  add_bench_size(app, *options);
  value(app, "--reference", "FILE", options->reference, "the picture that counts as right, such as an EXR")
      ->required();
  value(app, "--integrators", "LIST", options->integrators, "integrators (default: the scene's own)");
  value(app, "--samplers", "LIST", options->samplers, "samplers (default auto,sobol,independent)");
  value(app, "--counts", "LIST", options->counts, "samples a pixel (default 1,4,16,64)");
  value(app, "--goal", "E", options->goal, "the rms error to whose time ways are compared (default 0.02)");
}

}  // namespace sundog
