// Times of one scene against image size and number of threads, the tables of many a paper: threads are the
// compute units of a sub-device.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bench/report/report.h"
#include "bench/runs/measure.h"
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

/// Times a small frame of the scene, which also compiles its kernels into the cache. Zeros where it cannot be
/// drawn.
PixelCost pixel_cost(const ThreadScaling& plan);

/// The sizes and counts of a plan, all in turn. An image that is not that of the size's first count to the
/// bit is a problem, and so is the plain program's when it is another but for rounding.
class ThreadTimes {
 public:
  explicit ThreadTimes(ThreadScaling plan);

  void measure(const MeasureOptions& options);
  /// Adds the scene's tables (times, speed-up, efficiency), curves and measurements.
  void add_to(Report& report) const;

 private:
  const Subject* find(int size, unsigned threads) const;
  std::optional<Spread> speed_up(int size, unsigned count) const;
  std::string tiny_sizes() const;
  Table pivot(const std::string& title, const std::string& unit,
              const std::function<Cell(int, unsigned)>& cell) const;

  ThreadScaling plan_;
  std::vector<std::pair<int, unsigned>> ways_;  // side and threads of each subject; 0 threads: plain C++
  std::vector<Subject> subjects_;
};

}  // namespace sundog
