// An image's levels as tiles of texels.
#pragma once
#include <vector>

#include "base/pixels/image_levels.h"
#include "shared/textures.h"

namespace sundog {

/// TEXEL_* of an image.
u32 texel_format(const StoredImage& image);

/// Bytes of an image and its smaller levels on a device.
std::size_t texel_bytes(const StoredImage& image);

/// Where levels of these sizes lie, the first one at `first` units; returns the first free unit behind them.
std::size_t lay_out_levels(const StoredImage& image, std::size_t first, std::vector<TexelLevel>& levels);

/// The memory of all levels, in pages of `units` each.
struct TexelPages {
  std::uint8_t* bytes[TEXEL_PAGES];
  std::size_t units;
};

/// Writes the image and its smaller levels to their places.
void write_levels(const StoredImage& image, SampleUse use, const TexelLevel* levels, const TexelPages& pages);

}  // namespace sundog
