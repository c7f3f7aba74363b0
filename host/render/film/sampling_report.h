// Where the samples of a frame in passes went: figures, and a picture.
#pragma once
#include <cstdint>
#include <vector>

#include "base/image.h"
#include "shared/types.h"

namespace sundog {

struct SamplingFigures {
  std::uint64_t samples = 0;      // taken
  double mean = 0;                // a pixel
  u32 most = 0;                   // of any pixel
  double share_interpolated = 0;  // of the pixels: done without a sample of their own
  double saved = 0;               // share of the camera's rays that `each` samples a pixel would have taken
};

/// `taken`: samples of each pixel; `done`: 1 for each pixel that is complete, as Film::done; `surfaces`:
/// further camera rays; `each`: the samples a pixel of a frame in which all have the same.
SamplingFigures sampling_figures(const std::vector<u32>& taken, const std::vector<std::uint8_t>& done,
                                 std::uint64_t surfaces, u32 each);

/// Blue: no sample (interpolated); then the more samples, the brighter, by their logarithm.
Image sampling_picture(const std::vector<u32>& taken, int width, int height);

}  // namespace sundog
