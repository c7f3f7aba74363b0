#include "compile/texels.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstring>

#include "base/pixels/image_levels.h"

namespace sundog {
namespace {

u32 tiles_along(int edge) { return (static_cast<u32>(edge) + TEXEL_TILE - 1) / TEXEL_TILE; }

/// Units of a level, rounded up so that no tile crosses the end of a page.
std::size_t units_of(const TexelLevel& level, u32 format) {
  const std::size_t tiles = std::size_t{level.row_tiles} * tiles_along(static_cast<int>(level.height));
  const std::size_t units = tiles << (format & TEXEL_SIZE_MASK);
  return (units + TEXEL_ALIGNMENT - 1) / TEXEL_ALIGNMENT * TEXEL_ALIGNMENT;
}

/// Tile by tile; what a tile has beyond the image's edge stays 0 and is never read.
void write_level(const StoredImage& image, const TexelLevel& level, std::vector<u32>& texels) {
  auto* to = reinterpret_cast<std::uint8_t*>(texels.data()) + std::size_t{level.first} * TEXEL_UNIT;
  const std::size_t bytes = image.pixel_bytes(), row = static_cast<std::size_t>(image.width) * bytes;
  tbb::parallel_for(tbb::blocked_range<u32>(0, tiles_along(image.height), 8), [&](const auto& range) {
    for (u32 tile_y = range.begin(); tile_y != range.end(); ++tile_y)
      for (u32 tile_x = 0; tile_x < level.row_tiles; ++tile_x) {
        const std::size_t tile = std::size_t{tile_y} * level.row_tiles + tile_x;
        const u32 columns = std::min(TEXEL_TILE, level.width - tile_x * TEXEL_TILE);
        const u32 rows = std::min(TEXEL_TILE, level.height - tile_y * TEXEL_TILE);
        for (u32 y = 0; y < rows; ++y)
          std::memcpy(to + (tile * TEXEL_TILE + y) * TEXEL_TILE * bytes,
                      image.data.data() + (std::size_t{tile_y} * TEXEL_TILE + y) * row +
                          std::size_t{tile_x} * TEXEL_TILE * bytes,
                      columns * bytes);
      }
  });
}

}  // namespace

u32 texel_format(const StoredImage& image) {
  const bool grey = image.channels == 1;
  switch (image.sample) {
    case StoredImage::Sample::byte:
      return grey ? TEXEL_GREY8 : TEXEL_RGBA8;
    case StoredImage::Sample::word:
      return grey ? TEXEL_GREY16 : TEXEL_RGBA16;
    case StoredImage::Sample::half:
      return grey ? TEXEL_GREY_HALF : TEXEL_RGBA_HALF;
  }
  return TEXEL_RGBA8;
}

std::size_t lay_out_levels(const StoredImage& image, std::size_t first, std::vector<TexelLevel>& levels) {
  const u32 format = texel_format(image);
  for (int width = image.width, height = image.height;;
       width = std::max(1, width / 2), height = std::max(1, height / 2)) {
    levels.push_back(
        {static_cast<u32>(first), static_cast<u32>(width), static_cast<u32>(height), tiles_along(width)});
    first += units_of(levels.back(), format);
    if (width == 1 && height == 1) return first;
  }
}

std::size_t texel_bytes(const StoredImage& image) {
  std::vector<TexelLevel> levels;
  return lay_out_levels(image, 0, levels) * TEXEL_UNIT;
}

void write_levels(const ImageDescription& image, const TexelLevel* levels, std::vector<u32>& texels) {
  write_level(image.pixels, levels[0], texels);
  const std::vector<StoredImage> smaller = smaller_levels(image.pixels, image.srgb);
  for (std::size_t i = 0; i < smaller.size(); ++i) write_level(smaller[i], levels[i + 1], texels);
}

}  // namespace sundog
