// Coarse previews of a frame: one pixel per block, in ever smaller blocks. They are only for display; none of
// their samples enter the frame.
#pragma once
#include <vector>

#include "render/film/pass.h"

namespace sundog {

/// The edge of the first blocks in pixels, such that their picture takes about a twentieth of a second, given
/// the seconds per pixel (0: unknown); 0 if all pixels are nearly as fast.
int first_block(double pixel_seconds, std::size_t pixels);

/// The edge of the blocks after `block`; 0: full resolution. The remaining time must justify the additional
/// pass.
int next_block(int block, double pixel_seconds, std::size_t pixels);

/// Expected seconds per pixel of a whole image, from a coarse pass and the previous frame (0: unknown).
double expected_pixel_seconds(double coarse, double before);

/// The pass over the centre pixel of each block.
Pass coarse_pass(int width, int height, int block);

/// The latest complete coarse picture.
struct CoarsePicture {
  int block = 0;  // 0: none
  int columns = 0;
  std::vector<float4> colors;  // per block, row by row: linear RGB and coverage

  /// Replaces the picture.
  void take(const Pass& pass, const Film& made, int image_width, int image_height, int edge);
  const float4& at(int x, int y) const {
    return colors[static_cast<std::size_t>(y / block) * static_cast<std::size_t>(columns) +
                  static_cast<std::size_t>(x / block)];
  }
};

}  // namespace sundog
