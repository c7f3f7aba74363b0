// Times of one scene against image size and number of threads, the tables of many a paper: threads are the
// compute units of a sub-device.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "bench/report/report.h"
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
  int repeat = 5;
  bool plain = true;  // time the plain C++ integrator too: one frame a size, up to this one
  int greatest_plain_size = 1 << 16;
  unsigned cores = 1;  // that the threads can have
  PixelCost cost;      // by pixel_cost(), for estimates
};

/// One size and count; 0 threads: the plain C++ program. `cores` is processor seconds by wall second: what
/// the threads really had.
struct ThreadTime {
  int size = 0;
  unsigned threads = 0;
  Spread seconds;
  double cores = 0;
  std::string problem;  // not empty: no time counts, and why
};

/// Times a small frame of the scene, which also compiles its kernels into the cache. Zeros where it cannot be
/// drawn.
PixelCost pixel_cost(const ThreadScaling& plan);

/// What is being measured, and which part of the expected time is over, from 0 to 1.
using OnPart = std::function<void(const std::string& step, double done)>;

/// Warms up, then times `repeat` frames of each count in turn, and one frame of plain C++; a count whose
/// image is not that of the first one to the bit has a problem instead of a time, and so has the plain
/// program when its image is another.
std::vector<ThreadTime> measure_threads(const ThreadScaling& plan, const OnPart& on_part);

/// Adds the scene's tables (times, speed-up, efficiency), curves and measurements.
void add_thread_tables(Report& report, const ThreadScaling& plan, const std::vector<ThreadTime>& times);

}  // namespace sundog
