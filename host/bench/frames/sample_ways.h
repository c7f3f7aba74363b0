// Frames whose samples are shared out among the pixels, against frames with the same number for each: time,
// rays and error of adaptive and subsampled frames.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "bench/frames/sample_scaling.h"

namespace sundog {

/// One way to share samples out.
struct SampleWay {
  std::string name;                    // for the report
  std::vector<std::string> overrides;  // of the scene
};

struct SampleWays {
  std::string scene;
  std::function<CompiledScene(const std::vector<std::string>& overrides)> compile_with;
  DeviceInfo device;
  std::vector<SampleWay> ways;
  int reference = 128, repeat = 5;
};

struct WayTime {
  std::string name;
  Spread seconds;
  double rays = 0, samples_a_pixel = 0;  // rays of all kinds, those that only look among them
  double rms = 0;
  double even_rays = 0;  // that even samples take to the same error, from `even`; 0: beyond what was measured
};

/// The rays that `even` samples would need for an error of `rms`: between two measured counts as a power.
double rays_for_error(const std::vector<SampleTime>& even, double rms);

/// Renders the reference, warms each way up, and times `repeat` frames of each in turn.
std::vector<WayTime> measure_ways(const SampleWays& plan, const std::vector<SampleTime>& even,
                                  const std::function<void(const std::string&)>& on_step);

/// Adds a table of them.
void add_way_table(Report& report, const SampleWays& plan, const std::vector<WayTime>& times);

}  // namespace sundog
