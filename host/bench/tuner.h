// Tunes a device on a scene: measures frames, rejects what changes a bit of the image.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "render/tuning.h"

namespace sundog {

struct TuneOutcome {
  TuningEntry entry;  // of one kernel; the defaults, with equal times, where nothing was faster
  std::size_t tried = 0, rejected = 0;
};

/// Searches for about `budget` seconds: most of it for the frame, the rest for the kernel of the AOVs. An
/// outcome for each. Throws DeviceError, BuildError when the defaults do not work.
/// `on_step` hears what is tried.
std::vector<TuneOutcome> tune_device(const DeviceInfo& device, const CompiledScene& scene,
                                     const std::string& scene_name, double budget,
                                     const std::function<void(const std::string&)>& on_step);

}  // namespace sundog
