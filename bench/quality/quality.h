// Error by time: pictures of several samplers and integrators, with more and more samples, against a
// reference that is given.
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bench/report/report.h"
#include "bench/runs/measure.h"
#include "compile/compiled_scene.h"
#include "device/devices.h"

namespace sundog {

/// One way to render the scene: settings, and what the report calls it.
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
  double goal = 0.02;  // root mean square error to whose time ways are compared
};

/// One way with one number of samples.
struct QualityTime {
  QualityWay way;
  int samples = 0;
  Spread seconds;
  double rms = 0, perceived = 0;  // against the reference
};

/// Seconds until a way has the error `goal`, between two measured ones as a power of the error; 0: none was
/// measured on one of its sides.
double seconds_to(const std::vector<QualityTime>& of_one_way, double goal);

class QualityTimes {
 public:
  explicit QualityTimes(QualityPlan plan);

  /// Times frames of all ways and counts in turn. Throws UsageError where the scene's picture has another
  /// size than the reference.
  void measure(const MeasureOptions& options);
  /// Adds tables, curves and measurements.
  void add_to(Report& report) const;

 private:
  std::vector<std::vector<QualityTime>> by_way() const;
  CurvePlot curves(const std::string& what, const std::function<double(const QualityTime&)>& error_of) const;
  Table goal_table() const;

  QualityPlan plan_;
  std::vector<std::shared_ptr<QualityTime>> times_;  // of each way, its counts
  std::vector<Subject> subjects_;
};

}  // namespace sundog
