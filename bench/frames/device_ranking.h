// Devices and their combinations on one scene, best first, with the share of the picture that each made.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bench/report/report.h"
#include "bench/runs/measure.h"
#include "render/render.h"

namespace sundog {

/// Each device alone, each pair, and all together; no device with a part of itself. Pure.
std::vector<std::vector<DeviceInfo>> device_combinations(const std::vector<DeviceInfo>& devices);

/// The rate of a combination over the sum of its devices' rates alone: all take part or count as idle. Pure;
/// nothing where a time is not known.
std::optional<double> combined_efficiency(double seconds, const std::vector<double>& alone);

class DeviceRanking {
 public:
  DeviceRanking(std::string scene_name, std::shared_ptr<const CompiledScene> scene,
                const std::vector<DeviceInfo>& devices);
  ~DeviceRanking();

  /// Frames of all combinations in turn, on devices that are opened once. A picture that is not the first
  /// device's but for rounding is a problem, or not its to the bit where all devices of a combination draw
  /// the same bits.
  void measure(const MeasureOptions& options);
  /// Adds the ranking, bars and measurements.
  void add_to(Report& report) const;

 private:
  struct Combination;
  std::optional<double> efficiency(const Combination& combination) const;

  std::string name_;
  std::shared_ptr<const CompiledScene> scene_;
  std::vector<std::shared_ptr<Combination>> combinations_;
  std::vector<Subject> subjects_;
};

}  // namespace sundog
