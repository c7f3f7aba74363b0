// Plans a frame's tiles from the options: region, tile size, split, part of the frame.
#pragma once
#include <optional>
#include <span>

#include "render/frame/tile_queue.h"
#include "render/values/options.h"

namespace sundog {

/// Throws UsageError for a region that a picture of that size does not contain.
void check_region(const std::optional<Tile>& region, int width, int height);

/// The pixels of such a picture that a frame makes: the region grown to whole blocks of tile_align, so that
/// its pixels have the bits that they have in the whole picture; without a region all.
Tile frame_area(const std::optional<Tile>& region, int width, int height);

/// The unfinished tiles of `film`. `estimates` of device speeds divide a fixed split without shares.
TilePlan plan_tiles(const RenderOptions& options, const Film& film, std::span<const double> estimates);

}  // namespace sundog
