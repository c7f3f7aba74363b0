// Estimates how long `bench threads` takes, and shortens a plan that takes too long. Pure arithmetic.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "compile/compiled_scene.h"
#include "device/devices.h"

namespace sundog {

/// Seconds per pixel on one thread; 0: unknown.
struct PixelCost {
  double device = 0, plain = 0;
};

struct ThreadScaling {
  std::string scene;  // its name, for the report
  /// Compiles the scene for a square image of `size` pixels a side.
  std::function<CompiledScene(int size)> compile_for;
  DeviceInfo device;  // must support sub-devices
  std::vector<int> sizes{128, 256, 352, 448, 512, 640};
  std::vector<unsigned> counts{1, 2, 4, 8, 16};
  int repeat = 6;
  bool plain = true;  // also time the plain C++ integrator: one frame for each size up to greatest_plain_size
  int greatest_plain_size = 1 << 16;
  unsigned cores = 1;  // available to the threads
  PixelCost cost;      // by pixel_cost(), for estimates
};

/// Estimated seconds of one frame of the size on that many threads.
double frame_seconds(const ThreadScaling& plan, int size, unsigned threads);
double plain_seconds(const ThreadScaling& plan, int size);

/// Estimated seconds of the whole plan.
double expected_seconds(const ThreadScaling& plan);

/// Shortens the plan to at most `seconds`, as far as possible: first drops plain C++ at the larger sizes,
/// until it takes at most a third of the time; then frames, down to three; then the larger sizes, down to
/// one. Returns a phrase for each omission.
std::vector<std::string> fit_into(ThreadScaling& plan, double seconds);

}  // namespace sundog
