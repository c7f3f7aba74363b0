// Runs `sundog render`: reads a scene, renders it, and writes the image and the other outputs.
#pragma once
#include "app/render/draw_frame.h"

namespace sundog {

/// Renders the command's frame, part of a frame, or frames. Returns the exit status.
int render_scene(const RenderCommand& command);

}  // namespace sundog
