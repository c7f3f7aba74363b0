// Stores an image's mip levels as tiles of texels.
#pragma once
#include <vector>

#include "base/pixels/image_levels.h"
#include "shared/textures.h"

namespace sundog {

/// The image's TEXEL_* format.
u32 texel_format(const StoredImage& image);

/// Size of an image and its mip levels on a device, in bytes.
std::size_t texel_bytes(const StoredImage& image);

/// Places levels from `first` on, in units; returns the first free unit after them.
std::size_t lay_out_levels(const StoredImage& image, std::size_t first, std::vector<TexelLevel>& levels);

/// The memory of all levels, in pages of `units` each.
struct TexelPages {
  std::uint8_t* bytes[TEXEL_PAGES];
  std::size_t units;
};

/// Writes the image and its mip levels to their places.
void write_levels(const StoredImage& image, SampleUse use, const TexelLevel* levels, const TexelPages& pages);

}  // namespace sundog
