// Times and errors of one scene against the samples a pixel, and of frames whose samples are shared out among
// the pixels: what a sample costs, and what it buys.
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/image_compare.h"
#include "bench/report/report.h"
#include "bench/runs/measure.h"
#include "compile/compiled_scene.h"
#include "device/devices.h"

namespace sundog {

/// In linear colour: a pixel that is off by more looks wrong.
inline constexpr double visible_error = 0.02;

/// One way to share samples out.
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
  int reference = 128;          // samples of the picture that counts as right
};

/// Figures of one way, from its first frame.
struct SampleFigures {
  double samples = 0;     // a pixel, in the mean
  double rays = 0;        // of a frame, of all kinds, those that only look too
  ImageDifference error;  // from the reference, in linear color; tolerance visible_error
};

/// The rays that even frames need for an error of `rms`: between two measured ones as a power; 0: beyond
/// what was measured.
double rays_for_error(const std::vector<SampleFigures>& even, double rms);

class SampleTimes {
 public:
  explicit SampleTimes(SampleScaling plan);

  /// Renders the reference, then frames of all ways in turn.
  void measure(const MeasureOptions& options);
  /// Adds the tables, the curves and the measurements.
  void add_to(Report& report) const;

 private:
  std::vector<SampleFigures> even() const;
  double of_even(std::size_t way) const;
  Table even_table() const;
  Table way_table() const;
  CurvePlot even_curves(const std::string& what, const std::string& unit,
                        const std::function<Spread(std::size_t way)>& value) const;
  CurvePlot error_curves(const std::string& what, const std::string& unit,
                         const std::function<double(std::size_t way)>& cost) const;
  std::vector<Field> figures(std::size_t way) const;

  SampleScaling plan_;
  std::vector<std::shared_ptr<SampleFigures>> figures_;  // of each way
  std::vector<Subject> subjects_;
  std::shared_ptr<Image> reference_;
};

}  // namespace sundog
