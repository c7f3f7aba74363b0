// A frame that is rendered to its end: planned, run by a session, gathered. Internal to the session.
#pragma once
#include <functional>
#include <memory>
#include <vector>

#include "compile/compiled_scene.h"
#include "render/frame/frame.h"
#include "render/frame/result.h"

namespace sundog {

/// Plans the frame, or continues its checkpoint; has `run` run it; gathers what was made. Throws what
/// render() does (render.h).
RenderResult render_frame(const std::shared_ptr<const CompiledScene>& scene,
                          const std::vector<WorkerPlan>& devices, const RenderOptions& options,
                          const std::function<void(const std::shared_ptr<Frame>&)>& run);

/// Runs a frame by a session of its own workers, which are closed behind it. With `wait`, every thread has
/// ended on return; otherwise DeviceInfo::threads takes over the threads inside a driver.
void run_frame(const std::shared_ptr<Frame>& frame, bool wait);

}  // namespace sundog
