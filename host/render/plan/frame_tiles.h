// Plans a frame's tiles from the options: tile size, split, part of the frame.
#pragma once
#include <span>

#include "render/plan/tile_queue.h"
#include "render/values/options.h"

namespace sundog {

/// The unfinished tiles of `film`. `estimates` of device speeds divide a fixed split without shares.
TilePlan plan_tiles(const RenderOptions& options, const Film& film, std::span<const double> estimates);

}  // namespace sundog
