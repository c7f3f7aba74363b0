// Watches a frame from the caller's thread until it is over: reports progress, shows the picture, saves
// checkpoints, ends it at its time limit or at the caller's wish, retires workers that hang.
#pragma once
#include "render/frame/frame.h"

namespace sundog {

/// Waits for the frame's end: finished, stopped (options.stop), or out of workers. With `wait`, every worker
/// has left it on return; otherwise, after a short grace period, workers inside a driver are abandoned.
void watch_frame(Frame& frame, bool wait);

}  // namespace sundog
