// A device's roofline (Williams, Waterman and Patterson, "Roofline: An Insightful Visual Performance Model
// for Multicore Architectures", 2009), and where the tracer's kernels lie under it.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "bench/rays/ray_times.h"
#include "bench/roofline/device_peaks.h"

namespace sundog {

struct NamedScene {
  std::string name;
  std::shared_ptr<const CompiledScene> scene;
};

class Roofline {
 public:
  /// `rays`: camera rays a side.
  Roofline(const DeviceInfo& device, unsigned megabytes, const std::vector<NamedScene>& scenes,
           unsigned rays);
  void measure(const MeasureOptions& options);
  void add_to(Report& report) const;

 private:
  struct Traced {
    NamedScene scene;
    std::shared_ptr<RayTimes> times;
  };
  void add_scene(Report& report, const Traced& traced) const;

  DeviceInfo info_;
  DevicePeaks peaks_;
  std::vector<Traced> traced_;
};

}  // namespace sundog
