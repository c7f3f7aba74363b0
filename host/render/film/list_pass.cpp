// Lists an image's pixels along Z-curves, and packs lists of pixels into passes of 4x4 blocks.
#include <algorithm>
#include <array>

#include "render/film/pass.h"

namespace sundog {
namespace {

// Width of a list pass in pixels, a multiple of its 4x4 blocks.
constexpr std::size_t list_width = 256, block = 4, pixels_of_block = block * block;

// Edge, in pixels, of the squares in which the image is traversed.
constexpr std::size_t side = 16;

/// The pixels of a square along a Z-curve (Morton 1966), x | y << 16: neighbours in this order are neighbours
/// in the image.
constexpr std::array<u32, side * side> z_curve = [] {
  std::array<u32, side * side> places{};
  for (u32 i = 0; i < side * side; ++i)
    for (u32 bit = 0; bit < 4; ++bit)
      places[i] |= (i >> (2 * bit) & 1u) << bit | (i >> (2 * bit + 1) & 1u) << (16 + bit);
  return places;
}();

/// Whether any value of the block exceeds the limit. Without branches, so that the compiler vectorises it.
bool any_above(float limit, const float* corner, std::size_t width) {
  unsigned above = 0;
  for (std::size_t y = 0; y < block; ++y)
    for (std::size_t x = 0; x < block; ++x) above |= corner[y * width + x] > limit;
  return above;
}

/// Calls visit(x, y) for the upper left corner of each 4x4 block, in the order of all_pixels().
template <class Visit>
void for_all_blocks(u32 width, u32 height, const Visit& visit) {
  for (u32 top = 0; top < height; top += side)
    for (u32 left = 0; left < width; left += side)
      for (std::size_t i = 0; i < z_curve.size(); i += pixels_of_block)
        visit(left + (z_curve[i] & 0xffffu), top + (z_curve[i] >> 16));
}

/// The index in the pass of the i-th pixel of a list.
std::size_t place_in_list(std::size_t i, std::size_t pass_width) {
  const std::size_t columns = pass_width / block, at = i / pixels_of_block, in = i % pixels_of_block;
  return (at / columns * block + in / block) * pass_width + at % columns * block + in % block;
}

}  // namespace

std::vector<u32> all_pixels(int image_width, int image_height) {
  const auto width = static_cast<u32>(image_width), height = static_cast<u32>(image_height);
  std::vector<u32> pixels;
  pixels.reserve(std::size_t{width} * height);
  for_all_blocks(width, height, [&](u32 left, u32 top) {
    for (std::size_t i = 0; i < pixels_of_block; ++i) {
      const u32 x = left + (z_curve[i] & 0xffffu), y = top + (z_curve[i] >> 16);
      if (x < width && y < height) pixels.push_back(x | y << 16);
    }
  });
  return pixels;
}

std::vector<u32> pixels_above(const std::vector<float>& limits, const std::vector<float>& values,
                              int image_width, int image_height) {
  const auto width = static_cast<u32>(image_width), height = static_cast<u32>(image_height);
  const u32 columns = cost_blocks_along(image_width);
  std::vector<u32> pixels;
  for_all_blocks(width, height, [&](u32 left, u32 top) {
    if (left >= width || top >= height) return;
    const float limit = limits[top / block * columns + left / block];
    const float* corner = &values[std::size_t{top} * width + left];
    if (left + block <= width && top + block <= height && !any_above(limit, corner, width)) return;
    for (std::size_t i = 0; i < pixels_of_block; ++i) {
      const u32 x = z_curve[i] & 0xffffu, y = z_curve[i] >> 16;
      if (left + x < width && top + y < height && corner[std::size_t{y} * width + x] > limit)
        pixels.push_back((left + x) | (top + y) << 16);
    }
  });
  return pixels;
}

Pass list_pass(const std::vector<u32>& pixels, u32 first_sample, u32 sample_count) {
  const std::size_t blocks = (pixels.size() + pixels_of_block - 1) / pixels_of_block;
  const std::size_t columns = std::clamp<std::size_t>(blocks, 1, list_width / block);
  const std::size_t width = columns * block, height = (blocks + columns - 1) / columns * block;
  Pass pass;
  pass.width = static_cast<int>(width), pass.height = static_cast<int>(height);
  pass.first_sample = first_sample, pass.sample_count = sample_count;
  pass.pixels.assign(width * height, NO_PIXEL);
  for (std::size_t i = 0; i < pixels.size(); ++i) pass.pixels[place_in_list(i, width)] = pixels[i];
  return pass;
}

bool is_list_size(int width, int height) {
  constexpr int most = static_cast<int>(list_width), edge = static_cast<int>(block);
  return width > 0 && width <= most && width % edge == 0 && height > 0 && height % edge == 0;
}

std::vector<u32> pixels_of(const Pass& pass) {
  if (pass.pixels.empty()) return all_pixels(pass.width, pass.height);
  std::vector<u32> pixels(pass.pixels.size());
  for (std::size_t i = 0; i < pixels.size(); ++i)
    pixels[i] = pass.pixels[place_in_list(i, static_cast<std::size_t>(pass.width))];
  while (!pixels.empty() && pixels.back() == NO_PIXEL) pixels.pop_back();
  return pixels;
}

}  // namespace sundog
