// The checkpoint of a frame. Internal to the render layer.
#pragma once
#include "render/frame/frame.h"

namespace sundog {

/// Continues the frame from its checkpoint. Returns whether there is one. Throws for one that is damaged or
/// of another frame.
bool continue_checkpoint(Frame& frame);

/// Keeps what is done, every so often or when the caller wishes it, against what gives no warning: a process
/// killed, a machine that goes down.
void renew_checkpoint(Frame& frame);

/// Keeps what an interrupted frame has; a disk that is full must not take the image along.
void keep_checkpoint(const Frame& frame, RenderResult& result);

}  // namespace sundog
