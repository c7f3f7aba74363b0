// Renders tiles of a frame with one of its workers, and handles the worker's failures. Internal to the render
// layer.
#pragma once
#include "base/error.h"
#include "render/frame/frame.h"

namespace sundog {

/// The request for a tile, with its pixels' earlier samples; nothing if the frame is over.
std::optional<TileRequest> request_of(Frame& frame, const Tile& tile);

/// Has the worker render a tile of the frame, translated to the frame's place in the picture.
TileResult render_in_picture(const Frame& frame, DeviceWorker& worker, TileRequest request,
                             const StopFlags& flags);

void take_figures(Frame& frame, std::size_t i);

/// Handles worker i's failure at a tile, in the handler that caught it: returns the tile to the queue and
/// reopens the worker. Returns false if the frame is stopped. Rethrows the failure if the worker has failed
/// too often.
bool recover(Frame& frame, std::size_t i, const TileJob& job, const DeviceError& error);

}  // namespace sundog
