// Renders the frames of an animation.
#pragma once
#include <string>

#include "app/render/draw_frame.h"

namespace sundog {

/// The command for one frame, with numbered files.
RenderCommand frame_command(const RenderCommand& command, int frame);

/// The file that lists finished frames (FrameLog); empty: none.
std::string frame_list(const RenderCommand& command);

/// Renders the frames that are not done; waits for other processes' frames. Returns the exit status.
int render_frames(const RenderCommand& command, Setup& setup);

}  // namespace sundog
