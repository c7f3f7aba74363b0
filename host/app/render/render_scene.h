// `sundog render`.
#pragma once
#include "app/render/render_frame.h"

namespace sundog {

/// Renders what the command line asks for: a frame, a part of it, or frames. Returns the exit status.
int render_scene(const RenderCommand& command);

}  // namespace sundog
