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
  std::string family;                  // "adaptive", "subsampled": a curve of the report
  std::string setting;                 // the threshold, or the samples
  std::vector<std::string> overrides;  // of the scene
};

struct SampleWays {
  SampleScaling even;  // the frames that they are compared with
  std::function<CompiledScene(const std::vector<std::string>& overrides)> compile_with;
  std::vector<SampleWay> ways;
};

struct WayTime {
  SampleWay way;
  SampleTime time;             // `samples` is 0; rays that only look are among the rays
  double samples_a_pixel = 0;  // in the mean
  double even_rays = 0;        // that even samples take to the same error; 0: beyond what was measured
};

/// The rays that `even` samples would need for an error of `rms`: between two measured counts as a power.
double rays_for_error(const std::vector<SampleTime>& even, double rms);

/// Renders the reference, warms each way up, and times `repeat` frames of each in turn.
std::vector<WayTime> measure_ways(const SampleWays& plan, const std::vector<SampleTime>& even,
                                  const std::function<void(const std::string&)>& on_step);

/// Adds a table of them, curves beside those of `even`, and the measurements.
void add_way_tables(Report& report, const SampleWays& plan, const std::vector<SampleTime>& even,
                    const std::vector<WayTime>& times);

}  // namespace sundog
