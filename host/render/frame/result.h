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
  Image image;  // linear RGBA; alpha is coverage: 0 where only background was seen or nothing was rendered
  AovImages aovs;
  bool complete = true;  // false: stopped before the end
  RayCounts counts{};
  std::vector<DeviceReport> devices;
  double efficiency = 1;  // work done over what the devices could have done (plan.h)
  RenderTimes times;
  Film film;                     // what the image was developed from
  bool time_limited = false;     // it ended at the time limit
  std::uint64_t key = 0;         // of the scene, for write_checkpoint; 0 without a checkpoint
  std::exception_ptr failure;    // every device failed: what the last one threw (options.keep_failed)
  bool checkpoint_kept = false;  // an interrupted frame is in the checkpoint
  std::string checkpoint_left;   // why the frame did not continue from one (options.renews_checkpoint)
  std::string checkpoint_error;  // why it could not be written there
};

class DeviceWorker;

/// A worker to open, and what is known of its device and speed before.
struct WorkerPlan {
  DeviceInfo info;
  int processor = -1;  // devices with the same number run on the same cores (plan.h)
  std::function<std::shared_ptr<DeviceWorker>(const RenderOptions&)> make;
  // Measured in the previous frame, if that frame is comparable:
  double pixels_a_second = 0, measured_pixels = 0;
};

}  // namespace sundog
