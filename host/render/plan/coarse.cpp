// Chooses block sizes by the time that a pixel takes, and lists the blocks' centre pixels.
#include "render/plan/coarse.h"

#include <algorithm>

namespace sundog {
namespace {

// Seconds for the first picture; a frame faster than `soon` needs no coarse picture.
constexpr double first_seconds = 0.05, soon = 0.12;
// Frames longer than this many seconds have blocks of 4, and of 2.
constexpr double long_frame = 1.2, very_long_frame = 2.0;
// Relative cost of a coarse pass's pixels, because they share no work with neighbours.
constexpr double coarse_cost = 4;
constexpr int unknown_block = 8, greatest_block = 32;

double seconds_of(int block, double pixel_seconds, std::size_t pixels) {
  return pixel_seconds * static_cast<double>(pixels) / (double(block) * block);
}

}  // namespace

int first_block(double pixel_seconds, std::size_t pixels) {
  if (!(pixel_seconds > 0)) return unknown_block;
  if (seconds_of(1, pixel_seconds, pixels) < soon) return 0;
  int block = 4;
  while (block < greatest_block && seconds_of(block, pixel_seconds, pixels) > first_seconds) block *= 2;
  return block;
}

int next_block(int block, double pixel_seconds, std::size_t pixels) {
  const double frame = seconds_of(1, pixel_seconds, pixels);
  const int next = block / 2;
  if (next >= 8) return frame > soon ? next : 0;
  if (next == 4) return frame > long_frame ? next : 0;
  return next == 2 && frame > very_long_frame ? next : 0;
}

double expected_pixel_seconds(double coarse, double before) {
  return before > 0 && coarse >= before && coarse < coarse_cost * before ? before : coarse;
}

Pass coarse_pass(int width, int height, int block) {
  // In the order of all_pixels(), treating the blocks as pixels of a smaller image.
  std::vector<u32> middles = all_pixels((width + block - 1) / block, (height + block - 1) / block);
  const auto middle = [&](u32 at, int size) {
    return static_cast<u32>(std::min(static_cast<int>(at) * block + block / 2, size - 1));
  };
  for (u32& pixel : middles) pixel = middle(pixel & 0xffffu, width) | middle(pixel >> 16, height) << 16;
  return list_pass(middles, 0, 1);
}

void CoarsePicture::take(const Pass& pass, const Film& made, int image_width, int image_height, int edge) {
  block = edge;
  columns = (image_width + edge - 1) / edge;
  const int rows = (image_height + edge - 1) / edge;
  colors.assign(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), float4{});
  for (std::size_t i = 0; i < pass.pixels.size(); ++i) {
    if (pass.pixels[i] == NO_PIXEL || !(made.weights[i] > 0)) continue;
    const auto x = static_cast<int>(pass.pixels[i] & 0xffffu), y = static_cast<int>(pass.pixels[i] >> 16);
    const float4& sum = made.sums[i];
    const float weight = made.weights[i];
    colors[static_cast<std::size_t>(y / edge) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(x / edge)] = {sum.x / weight, sum.y / weight, sum.z / weight,
                                                  sum.w / weight};
  }
}

}  // namespace sundog
