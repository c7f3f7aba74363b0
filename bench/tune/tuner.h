// Tunes a device on a scene: measures frames, rejects what changes a bit of the image.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "render/device/tuning.h"

namespace sundog {

struct TuneOutcome {
  TuningEntry entry;  // of one kernel; the defaults, with equal times, where nothing was faster
  std::size_t tried = 0;
  std::vector<std::string> rejected;  // the settings and why
  std::size_t left_out = 0;           // there was no time for them
  std::string frames;  // what was drawn instead of whole frames: "200x150 pixels and 1 sample a pixel"
};

/// The most that has been measured on a device so far, in seconds; 0: nothing yet.
struct TuneCosts {
  double compile = 0;  // opening the device and drawing a frame with a program that had to be compiled
  double open = 0;     // ... with a program that was there
};

/// Hears what is tried, and what was found for each kernel as soon as it is known.
struct TuneListener {
  std::function<std::string(const std::string& step)> on_step;  // why it cannot be tried; "": it can
  std::function<void(const TuneOutcome& outcome)> on_outcome;
};

/// Searches for at most `budget` seconds, compilation included: most of it for the frame, the rest for the
/// kernel of the AOVs. Where a frame takes too large a part of the budget, smaller ones with fewer samples
/// are drawn. What is about to be compiled is taken to cost as much as the slowest so far; a compilation or a
/// launch that takes longer is waited for. Returns whether there was time for both kernels. Throws
/// DeviceError, BuildError when the defaults do not work.
bool tune_device(const DeviceInfo& device, const CompiledScene& scene, const std::string& scene_name,
                 double budget, TuneCosts& costs, const TuneListener& listener);

}  // namespace sundog
