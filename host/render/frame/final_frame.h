// The story of a frame that is rendered to its end: begin_frame() plans it, threads make its passes
// (session/frame_loop.h: run_frame()), finish_frame() takes the film and develops the image. Internal to the
// render layer.
#pragma once
#include <memory>
#include <vector>

#include "compile/compiled_scene.h"
#include "render/frame/frame.h"
#include "render/frame/result.h"

namespace sundog {

/// Plans the frame and begins its first pass, or continues its checkpoint. Throws what render() does
/// (render.h).
std::shared_ptr<Frame> begin_frame(const CompiledScene& scene, const std::vector<WorkerPlan>& devices,
                                   const RenderOptions& options);

/// Gathers what was made of a frame that is over. Throws the failure of the last device when the frame is
/// lost.
RenderResult finish_frame(Frame& frame);

}  // namespace sundog
