// Plans a frame's tiles from the options: tile size, split, part of the frame.
#pragma once
#include <span>

#include "render/frame/tile_queue.h"
#include "render/values/options.h"

namespace sundog {

/// The unfinished tiles of `film`. A fixed split without shares is divided by the devices' speed `estimates`.
TilePlan plan_tiles(const RenderOptions& options, const Film& film, std::span<const double> estimates);

}  // namespace sundog
