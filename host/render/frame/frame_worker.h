// A frame's workers: their requests and their failures. Internal to the render layer.
#pragma once
#include "base/error.h"
#include "render/frame/frame.h"

namespace sundog {

/// The request for a tile, with the earlier samples of its pixels; nothing when the frame is over.
std::optional<TileRequest> request_of(Frame& frame, const Tile& tile);

/// Has the worker render a tile of the frame, which lies somewhere in the picture.
TileResult render_in_picture(const Frame& frame, DeviceWorker& worker, TileRequest request,
                             const StopFlags& flags);

void take_figures(Frame& frame, std::size_t i);

/// Called where worker i's failure at a tile is caught: gives the tile back, and opens the worker again.
/// Returns false when the frame is over. Throws the failure when the worker has failed too often.
bool recover(Frame& frame, std::size_t i, const TileJob& job, const DeviceError& error);

}  // namespace sundog
