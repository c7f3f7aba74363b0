// Error by time: pictures of several samplers and integrators, with more and more samples, against a
// reference that is given.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "bench/report/report.h"
#include "compile/compiled_scene.h"
#include "device/devices.h"

namespace sundog {

/// One way to render the scene: settings, and what the report calls it.
struct QualityWay {
  std::string integrator, sampler;
};

struct QualityPlan {
  std::string scene;
  std::function<CompiledScene(const QualityWay& way, int samples)> compile_for;
  DeviceInfo device;
  std::vector<QualityWay> ways;
  std::vector<int> counts;  // samples a pixel, ascending
  Image reference;
  int repeat = 5;
  double goal = 0.02;  // root mean square error to whose time ways are compared
};

/// One way with one number of samples.
struct QualityTime {
  QualityWay way;
  int samples = 0;
  Spread seconds;
  double rms = 0, perceived = 0;  // against the reference
  std::string problem;            // empty: sound
};

/// Warms each way up, then times `repeat` frames of each in turn, and compares each picture to the bit with
/// its first. Throws UsageError where the scene's picture has another size than the reference.
std::vector<QualityTime> measure_quality(const QualityPlan& plan,
                                         const std::function<void(const std::string&)>& on_step);

/// Seconds until a way has the error `goal`, between two measured ones as a power of the error; 0: none was
/// measured on one of its sides.
double seconds_to(const std::vector<QualityTime>& of_one_way, double goal);

/// Adds tables, curves and measurements of them.
void add_quality(Report& report, const QualityPlan& plan, const std::vector<QualityTime>& times);

}  // namespace sundog
