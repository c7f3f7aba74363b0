// `sundog bench samples`: time and error by samples a pixel.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "app/options/option_helpers.h"
#include "base/error.h"
#include "base/image_compare.h"
#include "bench/commands/bench_run.h"
#include "bench/frames/frame_runner.h"
#include "bench/report/machine.h"
#include "bench/report/report.h"
#include "bench/runs/measure.h"
#include "compile/compiled_scene.h"
#include "device/devices.h"
#include "render/film/sampling_report.h"

namespace sundog {
namespace {

/// In linear colour; a pixel with a greater error looks wrong.
constexpr double visible_error = 0.02;

/// One way to distribute samples.
struct SampleWay {
  std::string family;                  // "even", "adaptive", "subsampled": a curve of the report
  std::string setting;                 // the samples, or the threshold
  std::vector<std::string> overrides;  // of the scene
};

struct SampleScaling {
  std::string scene;  // its name, for the report
  std::function<std::shared_ptr<const CompiledScene>(const std::vector<std::string>& overrides)> compile_with;
  DeviceInfo device;
  std::vector<SampleWay> ways;  // the even ones first, by ascending samples
  int reference = 128;          // samples of the reference picture
};

/// Figures of one way, from its first frame.
struct SampleFigures {
  double samples = 0;     // mean number per pixel
  double rays = 0;        // of a frame, of all kinds (FrameRunner::rays())
  ImageDifference error;  // from the reference, in linear color; tolerance visible_error
};

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

class SampleTimes {
 public:
  explicit SampleTimes(SampleScaling plan) : plan_(std::move(plan)), reference_(std::make_shared<Image>()) {
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
      subjects_.push_back(frame_subject(fmt::format("{}, {}, {}", place(), way.family, way.setting),
                                        {open, first, {}, {plan_.device}}));
    }
  }

  /// Renders the reference, then frames of all ways in turn.
  void measure(const MeasureOptions& options) {
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
    if (prepared(subjects_, options, draw_reference)) sundog::measure(subjects_, options);
  }

  /// Adds the tables, the curves and the measurements.
  void add_to(Report& report) const {
    const auto milliseconds = [&](std::size_t i) { return scaled(subjects_[i].seconds(), 1e3); };
    report.parts.emplace_back(even_table());
    report.parts.emplace_back(even_curves("error", "rms error (linear color)",
                                          [&](std::size_t i) { return exactly(figures_[i]->error.rms); }));
    report.parts.emplace_back(even_curves("time of a frame", "ms", milliseconds));
    report.parts.emplace_back(way_table());
    report.parts.emplace_back(error_curves("rays", "millions of rays",
                                           [&](std::size_t i) { return exactly(figures_[i]->rays / 1e6); }));
    report.parts.emplace_back(error_curves("time", "ms a frame", milliseconds));
    for (std::size_t i = 0; i < subjects_.size(); ++i) {
      const SampleWay& way = plan_.ways[i];
      const bool good = subjects_[i].is_good();
      std::vector<Field> more;
      if (good) {
        more = {{"samples", "", figures_[i]->samples}};
        for (const Field& field : figures(i)) more.push_back(field);
        more.push_back({"rays", "millions", figures_[i]->rays / 1e6});
        more.push_back({"of even rays", "%", of_even(i)});
      }
      add_measured(report, subjects_[i],
                   {{"scene", "", plan_.scene},
                    {"device", "", device_title(plan_.device)},
                    {"way", "", fmt::format("{}, {}", way.family, way.setting)},
                    {"reference samples", "", static_cast<double>(plan_.reference)}},
                   more);
    }
  }

 private:
  std::string place() const { return fmt::format("{} on {}", plan_.scene, device_title(plan_.device)); }

  /// The way's rays in per cent of the rays that even samples need for the same error; empty if unknown.
  Cell of_even(std::size_t way) const {
    if (plan_.ways[way].family == even_family) return 100.0;
    std::vector<ErrorCost> even;
    for (std::size_t i = 0; i < subjects_.size(); ++i)
      if (plan_.ways[i].family == even_family && subjects_[i].is_good())
        even.push_back({figures_[i]->error.rms, figures_[i]->rays});
    const double rays = cost_of_error(even, figures_[way]->error.rms);
    return rays > 0 ? Cell(100 * figures_[way]->rays / rays) : Cell();
  }

  Table even_table() const {
    Table table{place() + ": time and error by samples a pixel", {{"samples", ""}, {"time", "ms"}}, {}};
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

  Table way_table() const {
    Table table{
        place() + ": samples where they are needed", {{"samples", ""}, {"a pixel", ""}, {"time", "ms"}}, {}};
    for (std::size_t i = 0; i < subjects_.size(); ++i) {
      const SampleWay& way = plan_.ways[i];
      if (way.family == even_family) continue;
      std::vector<Field> row{{"samples", "", fmt::format("{}, {}", way.family, way.setting)}};
      if (subjects_[i].is_good()) {
        row.insert(row.end(), {{"a pixel", "", figures_[i]->samples},
                               {"time", "ms", milliseconds(subjects_[i])},
                               {"rays", "millions", figures_[i]->rays / 1e6},
                               {"rms error", "", figures_[i]->error.rms},
                               {"of even rays", "%", of_even(i)}});
      }
      add_row(table, row, subjects_[i]);
    }
    return table;
  }

  CurvePlot even_curves(const std::string& what, const std::string& unit,
                        const std::function<Spread(std::size_t way)>& value) const {
    Curve curve{device_title(plan_.device), {}};
    for (std::size_t i = 0; i < subjects_.size(); ++i)
      if (plan_.ways[i].family == even_family && subjects_[i].is_good())
        curve.points.push_back({figures_[i]->samples, value(i)});
    return {fmt::format("{}: {} by samples a pixel", place(), what), "samples a pixel", unit, {curve}, false};
  }

  /// Error over cost: a curve for each family of ways.
  CurvePlot error_curves(const std::string& what, const std::string& unit,
                         const std::function<Spread(std::size_t way)>& cost) const {
    std::vector<Curve> curves;
    for (std::size_t i = 0; i < subjects_.size(); ++i) {
      const std::string& family = plan_.ways[i].family;
      if (curves.empty() || curves.back().name != family) curves.push_back({family, {}});
      const double error = figures_[i]->error.rms;
      if (const Spread of = cost(i); subjects_[i].is_good() && error > 0 && of.median > 0)
        curves.back().points.push_back({of.median, exactly(error), median_interval(of)});
    }
    for (Curve& curve : curves) std::ranges::sort(curve.points, {}, &CurvePoint::x);
    return {
        fmt::format("{}: error by {}", place(), what), unit, "rms error (linear color)", curves, false, true};
  }

  std::vector<Field> figures(std::size_t way) const {
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

  SampleScaling plan_;
  std::vector<std::shared_ptr<SampleFigures>> figures_;  // of each way
  std::vector<Subject> subjects_;
  std::shared_ptr<Image> reference_;
};

struct SamplesOptions : BenchOptions {
  std::string counts = "1,5,17,26";
  int reference = 0;                        // 0: four times the largest count
  std::string adaptive = "0.01,0.02,0.05";  // thresholds
  double budget = 0;                        // seconds; 0: no limit
};

/// Even frames of each count; adaptive frames of each threshold, with up to four times the largest count per
/// pixel; subsampled frames of each count.
std::vector<SampleWay> sample_ways(const SamplesOptions& options, const std::vector<int>& counts) {
  std::vector<SampleWay> ways;
  for (const int samples : counts)
    ways.push_back({"even",
                    std::to_string(samples),
                    {fmt::format("/render/samples={}", samples), "/render/adaptive/threshold=0"}});
  for (const std::string& threshold : split_names(options.adaptive))
    ways.push_back(
        {"adaptive",
         threshold,
         {fmt::format("/render/samples={}", 4 * counts.back()), "/render/adaptive/threshold=" + threshold}});
  for (const int samples : counts)
    ways.push_back({"subsampled",
                    std::to_string(samples),
                    {fmt::format("/render/samples={}", samples), "/render/adaptive/threshold=0",
                     "/render/subsample/on=true"}});
  return ways;
}

int bench_samples(const SamplesOptions& options) {
  const std::vector<int> counts = parse_list("--counts", options.counts, 1, 65536);
  const int reference = options.reference > 0 ? options.reference : 4 * counts.back();
  if (reference <= counts.back())
    throw UsageError(fmt::format("--reference {}: wanted more than the {} samples that are compared with it",
                                 reference, counts.back()));
  BenchRun run("samples", "Time and error by samples a pixel", options);
  run.head().times_frames = true;
  run.head().notes.push_back(fmt::format(
      "Medians of frames after one to warm up; the ways take turns, and the image of each run was compared "
      "to the bit before its time counted. The error is the root mean square difference from the same "
      "device's picture with {} samples, in linear color; a pixel is visibly wrong if it is off by more than "
      "0.02. With independent samples \"error x sqrt(samples)\" would stay constant; these samples are "
      "spread evenly over the pixel and do better. \"of even rays\": of those that even samples take to the "
      "same error.",
      reference));
  const std::vector<DeviceInfo> devices = run.devices();
  const double parts = static_cast<double>(options.scenes.size() * devices.size());
  for (const std::string& file : options.scenes)
    for (const DeviceInfo& device : devices) {
      const auto compile_with = [&run, file](const std::vector<std::string>& overrides) {
        return run.compiled(file, overrides);
      };
      run.measure(std::make_shared<SampleTimes>(SampleScaling{scene_name(options, file), compile_with, device,
                                                              sample_ways(options, counts), reference}),
                  options.budget / parts);
    }
  return run.publish();
}

}  // namespace

void add_bench_samples(Arguments& bench, Command& chosen) {
  const auto options = std::make_shared<SamplesOptions>();
  Arguments* app = add_bench_command(bench, chosen, "samples", "Time and error by samples a pixel", options,
                                     bench_samples);
  add_bench_size(app, *options);
  value(app, "--counts", "LIST", options->counts, "samples a pixel (default 1,5,17,26)");
  value(app, "--reference", "N", options->reference,
        "samples of the picture that counts as right (default: four times the most)")
      ->range(2, 1 << 18);
  value(app, "--adaptive", "LIST", options->adaptive,
        "thresholds of the adaptive frames (default 0.01,0.02,0.05)");
  value(app, "--budget", "SECONDS", options->budget,
        "about how long it may take: then further runs, and ways, are left out (default: no limit)")
      ->range(0, 1e6);
}

}  // namespace sundog
