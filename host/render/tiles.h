// How a frame is cut and how long a launch may be: arithmetic that knows no device.
#pragma once
#include <vector>

#include "render/film.h"

namespace sundog {

/// Rectangles of `edge` pixels (rounded up to a multiple of `align`) that cover the image without overlap,
/// row by row; those on the right and lower edge are smaller. The order is the order of work.
std::vector<Tile> cut_tiles(int width, int height, int edge, int align = 4);

/// A tile edge that gives each of `devices` several tiles, without making them small.
int default_tile_edge(int width, int height, std::size_t devices);

/// Pixel-samples for the next launch, such that it takes about `target_seconds`: from the last launch's size
/// and time. Grows at most eightfold at a step; zero or negative time counts as very short. Result in [least,
/// most].
std::size_t next_launch_size(std::size_t last_size, double last_seconds, double target_seconds,
                             std::size_t least, std::size_t most);

}  // namespace sundog
