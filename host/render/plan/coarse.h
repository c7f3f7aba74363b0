// The first pictures of a frame that somebody waits for: one pixel of each block of them, in ever smaller
// blocks. They are only looked at: the frame itself is made of none of their samples.
#pragma once
#include <vector>

#include "base/image.h"
#include "render/film/growing_film.h"

namespace sundog {

/// The edge of the first blocks in pixels, such that their picture is there in about a twentieth of a second,
/// by the seconds that a pixel takes (0: not known); 0 where all pixels are as good as there at once.
int first_block(double pixel_seconds, std::size_t pixels);

/// The edge of the next blocks after those of `block`, 0 when all pixels come next. What is to come takes
/// longer than what is added to it by this.
int next_block(int block, double pixel_seconds, std::size_t pixels);

/// The seconds that a pixel of a whole image takes, by what it took in a coarse pass and in the frame before
/// (0: not known).
double expected_pixel_seconds(double coarse, double before);

/// The pass over the middle pixel of each block.
Pass coarse_pass(int width, int height, int block);

/// The picture of blocks that is complete.
struct CoarsePicture {
  int block = 0;  // 0: none is
  int columns = 0;
  std::vector<float4> colors;  // of each block, row by row: linear RGB and coverage

  /// Takes the place of what was there.
  void take(const Pass& pass, const Film& made, int image_width, int image_height, int edge);
  const float4& at(int x, int y) const {
    return colors[static_cast<std::size_t>(y / block) * static_cast<std::size_t>(columns) +
                  static_cast<std::size_t>(x / block)];
  }
};

}  // namespace sundog
