// Plans a frame's tiles from the options: region, tile size, split, part of the frame.
#pragma once
#include <optional>
#include <span>

#include "render/frame/tile_queue.h"
#include "render/values/options.h"

namespace sundog {

/// Throws UsageError unless the region lies within a picture of this size.
void check_region(const std::optional<Tile>& region, int width, int height);

/// The pixels of the picture that a frame renders: the region grown to whole blocks of tile_align, so that
/// its pixels have the same bits as in the whole picture; without a region, the whole picture.
Tile frame_area(const std::optional<Tile>& region, int width, int height);

/// The unfinished tiles of `film`. A fixed split without shares is divided by the devices' speed `estimates`.
TilePlan plan_tiles(const RenderOptions& options, const Film& film, std::span<const double> estimates);

}  // namespace sundog
