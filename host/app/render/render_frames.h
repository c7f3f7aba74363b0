// The frames of an animation, one after the other.
#pragma once
#include <string>

#include "app/render/render_frame.h"

namespace sundog {

/// The command of one frame: its files are numbered.
RenderCommand frame_command(const RenderCommand& command, int frame);

/// Where the command keeps which frames are done; empty: nowhere.
std::string frame_list(const RenderCommand& command);

/// Renders the frames that are not done. Frames that another process renders meanwhile are waited for.
/// Returns the exit status.
int render_frames(const RenderCommand& command, Setup& setup);

}  // namespace sundog
