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
  std::size_t left_out = 0;  // there was no time for them
};

/// The most that has been measured on a device so far, in seconds; 0: nothing yet.
struct TuneCosts {
  double compile = 0;  // opening the device and drawing a frame with a program that had to be compiled
  double open = 0;     // ... with a program that was there
};

/// Searches for at most `budget` seconds, compilation included: most of it for the frame, the rest for the
/// kernel of the AOVs. An outcome for each that there was time for: what is about to be compiled is taken to
/// cost as much as the slowest so far. Throws DeviceError, BuildError when the defaults do not work.
/// `on_step` hears what is tried.
std::vector<TuneOutcome> tune_device(const DeviceInfo& device, const CompiledScene& scene,
                                     const std::string& scene_name, double budget, TuneCosts& costs,
                                     const std::function<void(const std::string&)>& on_step);

}  // namespace sundog
