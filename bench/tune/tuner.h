// Tunes a device on a scene: measures frames, rejects settings that change a bit of the image.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "render/device/tuning.h"

namespace sundog {

struct TuneOutcome {
  TuningEntry entry;  // of one kernel; the defaults, with equal times, if nothing was faster
  std::size_t tried = 0;
  std::vector<std::string> rejected;  // the settings and why
  std::size_t left_out = 0;           // settings without time left to try them
  std::string frames;                 // drawn instead of whole frames: "200x150 pixels and 1 sample a pixel"
};

/// The greatest costs measured on a device so far, in seconds; 0: none yet.
struct TuneCosts {
  double compile = 0;  // opening the device and drawing a frame with a program that had to be compiled
  double open = 0;     // likewise, with a program from the cache
};

/// Called before each step, and with each kernel's result as soon as it is known.
struct TuneListener {
  std::function<std::string(const std::string& step)> on_step;  // why the step must not be tried; "": it may
  std::function<void(const TuneOutcome& outcome)> on_outcome;
};

/// Searches for at most `budget` seconds, compilation included: first for the frame's kernel, then, for the
/// rest, for the AOVs'. If a frame takes too much of the budget, renders smaller ones with fewer samples.
/// Assumes that each compilation costs as much as the slowest so far; waits for a compilation or launch that
/// takes longer. Returns whether there was time for both kernels. Throws DeviceError, BuildError if the
/// defaults do not work.
bool tune_device(const DeviceInfo& device, const CompiledScene& scene, const std::string& scene_name,
                 double budget, TuneCosts& costs, const TuneListener& listener);

}  // namespace sundog
