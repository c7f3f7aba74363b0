// A frame's result, and the plans of the workers that render it.
#pragma once
#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/image.h"
#include "device/devices.h"
#include "render/film/film.h"
#include "render/values/options.h"
#include "render/values/report.h"

namespace sundog {

struct RenderResult {
  Image image;  // linear RGBA; alpha is coverage: 0 if only background was seen or nothing was rendered
  AovImages aovs;
  bool complete = true;  // false: stopped before the end
  RayCounts counts{};
  std::vector<DeviceReport> devices;
  double efficiency = 1;  // work done, divided by the devices' capacity (plan.h)
  RenderTimes times;
  Film film;                     // from which the image was developed
  bool time_limited = false;     // it ended at the time limit
  std::uint64_t key = 0;         // hash of the scene, for write_checkpoint; 0 without a checkpoint
  std::exception_ptr failure;    // every device failed: the last one's exception (options.keep_failed)
  bool checkpoint_kept = false;  // an interrupted frame was saved as a checkpoint
  std::string checkpoint_left;   // why the old checkpoint was not used (options.renews_checkpoint)
  std::string checkpoint_error;  // why the checkpoint could not be written
};

class DeviceWorker;

/// A worker to be opened, and prior knowledge about its device and speed.
struct WorkerPlan {
  DeviceInfo info;
  int processor = -1;  // devices with the same number run on the same cores (plan.h)
  std::function<std::shared_ptr<DeviceWorker>(const RenderOptions&)> make;
  // Measured in the previous frame, if that frame is comparable:
  double pixels_a_second = 0, measured_pixels = 0;
};

}  // namespace sundog
