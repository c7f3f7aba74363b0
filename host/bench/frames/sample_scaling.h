// Times and errors of one scene against the samples a pixel: what a sample costs, and what it buys.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "base/image_compare.h"
#include "bench/report/report.h"
#include "compile/compiled_scene.h"
#include "device/devices.h"

namespace sundog {

/// In linear colour: a pixel that is off by more looks wrong.
inline constexpr double visible_error = 0.02;

struct SampleScaling {
  std::string scene;  // its name, for the report
  /// The scene compiled for so many samples a pixel.
  std::function<CompiledScene(int samples)> compile_for;
  DeviceInfo device;
  std::vector<int> counts{1, 2, 4, 8, 16, 32};  // ascending
  int reference = 128;                          // samples of the picture that counts as right
  int repeat = 5;
};

struct SampleTime {
  int samples = 0;
  Spread seconds;
  double rays = 0;        // of a frame, of all kinds
  ImageDifference error;  // from the reference, in linear color; tolerance visible_error
  std::string problem;    // not empty: no time counts, and why
};

/// Renders the reference, warms each count up, then times `repeat` frames of each in turn. A frame whose
/// image is not that of the warm-up to the bit is a problem. `on_step` hears what is being measured.
std::vector<SampleTime> measure_samples(const SampleScaling& plan,
                                        const std::function<void(const std::string&)>& on_step);

/// Appends a measurement: frames of `samples` a pixel, made in the given way ("even": the same number for
/// each). `of_even` are their rays in per cent of those that even samples need for the same error; 0:
/// unknown.
void add_measurement(Report& report, const SampleScaling& plan, const std::string& way,
                     const SampleTime& time, double samples, double of_even);

/// Adds the table, the curves and the measurements.
void add_sample_tables(Report& report, const SampleScaling& plan, const std::vector<SampleTime>& times);

}  // namespace sundog
