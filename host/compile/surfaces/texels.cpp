// Lays out an image's levels as tiles of texels, and writes its rows to them.
#include "compile/surfaces/texels.h"

#include <algorithm>
#include <cstring>

namespace sundog {
namespace {

u32 tiles_along(int edge) { return (static_cast<u32>(edge) + TEXEL_TILE - 1) / TEXEL_TILE; }

/// Units of a level, rounded up so that no tile crosses the end of a page.
std::size_t units_of(const TexelLevel& level, u32 format) {
  const std::size_t tiles = std::size_t{level.row_tiles} * tiles_along(static_cast<int>(level.height));
  const std::size_t units = tiles << (format & TEXEL_SIZE_MASK);
  return (units + TEXEL_ALIGNMENT - 1) / TEXEL_ALIGNMENT * TEXEL_ALIGNMENT;
}

/// Writes a level's rows to tiles; tile texels beyond the image's edge stay 0 and are never read.
class RowWriter {
 public:
  RowWriter(const StoredImage& image, const TexelPages& pages)
      : pages_(pages), format_(texel_format(image)) {}

  void operator()(const TexelLevel& level, u32 y, const std::uint8_t* samples) const {
    switch (format_ & TEXEL_SIZE_MASK) {
      case 0:
        return write<4>(level, y, samples);
      case 1:
        return write<8>(level, y, samples);
      case 2:
        return write<16>(level, y, samples);
      default:
        return write<32>(level, y, samples);
    }
  }

 private:
  /// Each tile gets `part` bytes of the row. Tiles do not cross pages.
  template <std::size_t part>
  void write(const TexelLevel& level, u32 y, const std::uint8_t* samples) const {
    const u32 shift = format_ & TEXEL_SIZE_MASK, whole = level.width / TEXEL_TILE;
    const std::size_t first = level.first + (std::size_t{y / TEXEL_TILE} * level.row_tiles << shift);
    for (u32 tile = 0; tile < level.row_tiles;) {
      const std::size_t unit = first + (std::size_t{tile} << shift), page = unit / pages_.units;
      const std::size_t fit = ((page + 1) * pages_.units - unit) >> shift;
      const auto end = static_cast<u32>(std::min<std::size_t>(level.row_tiles, tile + fit));
      std::uint8_t* to =
          pages_.bytes[page] + (unit - page * pages_.units) * TEXEL_UNIT + y % TEXEL_TILE * part;
      for (; tile < std::min(end, whole); ++tile, samples += part, to += part * TEXEL_TILE)
        std::memcpy(to, samples, part);
      if (tile < end) {
        std::memcpy(to, samples, level.width % TEXEL_TILE * (part / TEXEL_TILE));
        ++tile;
      }
    }
  }

  const TexelPages& pages_;
  u32 format_;
};

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

void write_levels(const StoredImage& image, SampleUse use, const TexelLevel* levels,
                  const TexelPages& pages) {
  const RowWriter write(image, pages);
  each_level_row(image, use, [&](std::size_t level, int y, const std::uint8_t* samples) {
    write(levels[level], static_cast<u32>(y), samples);
  });
}

}  // namespace sundog
