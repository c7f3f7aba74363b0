// The end of a frame: reports, image, AOVs. Internal to the render layer.
#pragma once
#include "render/frame/frame.h"

namespace sundog {

/// Whether it is complete, and why not.
void note_end(const Frame& frame, RenderResult& result);

/// Makes image and AOVs of the film; leaves the frame's region alone of all of them.
void develop(const Frame& frame, RenderResult& result);

/// Times, ray counts, and each worker's part.
void note_figures(const Frame& frame, RenderResult& result);

}  // namespace sundog
