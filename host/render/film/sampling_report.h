// How a frame in passes distributed its samples: statistics, and a picture.
#pragma once
#include <cstdint>
#include <vector>

#include "base/image.h"
#include "shared/types.h"

namespace sundog {

struct SamplingFigures {
  std::uint64_t samples = 0;      // samples taken
  double mean = 0;                // samples per pixel
  u32 most = 0;                   // maximum of all pixels
  double share_interpolated = 0;  // share of pixels finished without samples of their own
  double saved = 0;               // share of the camera rays saved, compared with `each` samples per pixel
};

/// `taken`: samples of each pixel; `done`: 1 for each finished pixel, as in Film::done; `surfaces`: further
/// camera rays; `each`: samples per pixel of a frame that samples all pixels equally.
SamplingFigures sampling_figures(const std::vector<u32>& taken, const std::vector<std::uint8_t>& done,
                                 std::uint64_t surfaces, u32 each);

/// Blue: no samples (interpolated); otherwise brightness is the square of the logarithm of the samples,
/// relative to the maximum.
Image sampling_picture(const std::vector<u32>& taken, int width, int height);

}  // namespace sundog
