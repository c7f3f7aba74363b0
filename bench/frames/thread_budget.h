// How long `bench threads` will take, and what to leave out where that is too long. Pure arithmetic.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "compile/compiled_scene.h"
#include "device/devices.h"

namespace sundog {

/// Seconds of a pixel, on one thread. Zeros: not known.
struct PixelCost {
  double device = 0, plain = 0;
};

struct ThreadScaling {
  std::string scene;  // its name, for the report
  /// The scene compiled for a square image of so many pixels a side.
  std::function<CompiledScene(int size)> compile_for;
  DeviceInfo device;  // splits into sub-devices
  std::vector<int> sizes{128, 256, 352, 448, 512, 640};
  std::vector<unsigned> counts{1, 2, 4, 8, 16};
  int repeat = 6;
  bool plain = true;  // time the plain C++ integrator too: one frame a size, up to this one
  int greatest_plain_size = 1 << 16;
  unsigned cores = 1;  // that the threads can have
  PixelCost cost;      // by pixel_cost(), for estimates
};

/// Seconds that one frame of the size takes on so many threads, by what a pixel costs.
double frame_seconds(const ThreadScaling& plan, int size, unsigned threads);
double plain_seconds(const ThreadScaling& plan, int size);

/// Seconds that measure_threads() will take.
double expected_seconds(const ThreadScaling& plan);

/// Makes the plan take `seconds` at most, as far as it can: plain C++ at the smaller sizes only, so that it
/// takes a third of the time at most; then fewer frames, three at least; then fewer sizes, one at least.
/// Returns what was left out, a phrase each.
std::vector<std::string> fit_into(ThreadScaling& plan, double seconds);

}  // namespace sundog
