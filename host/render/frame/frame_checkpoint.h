// Reads and writes a frame's checkpoint. Internal to the render layer.
#pragma once
#include "render/frame/frame.h"

namespace sundog {

/// Continues the frame from its checkpoint. Returns false if there is none. Throws for a damaged one or one
/// of another frame.
bool continue_checkpoint(Frame& frame);

/// Saves a checkpoint periodically, or when the caller asks, so that a killed process or a power failure
/// loses little.
void renew_checkpoint(Frame& frame);

/// Saves an interrupted frame. Records a full disk in `result` instead of throwing, so that the image can
/// still be written.
void keep_checkpoint(const Frame& frame, RenderResult& result);

}  // namespace sundog
