// A frame's tiles by what the user asked for: their size, a split, a part of the frame.
#pragma once
#include <span>

#include "render/plan/tile_queue.h"
#include "render/values/options.h"

namespace sundog {

/// What is unfinished of `film`. `estimates` of the devices' speeds divide a fixed split without shares.
TilePlan plan_tiles(const RenderOptions& options, const Film& film, std::span<const double> estimates);

}  // namespace sundog
