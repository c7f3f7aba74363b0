// Renders one frame with its own threads. Callers that render several frames keep a session
// (render/session/render_session.h), which keeps devices and kernels.
#pragma once
#include <memory>
#include <vector>

#include "compile/compiled_scene.h"
#include "render/frame/result.h"

namespace sundog {

/// Renders on all `devices` together and waits for each to finish. Throws DeviceError if every device failed,
/// BuildError if the kernels build on none, SceneError for a damaged checkpoint, UsageError for a checkpoint
/// of another scene, unknown AOVs, or shares that do not match the devices.
RenderResult render(const CompiledScene& scene, const std::vector<DeviceInfo>& devices,
                    const RenderOptions& options = {});

/// Does not wait for a driver that is still compiling or inside a launch when the frame is finished: its
/// thread, which holds the scene, is handed to DeviceInfo::threads.
RenderResult render(const std::shared_ptr<const CompiledScene>& scene, const std::vector<DeviceInfo>& devices,
                    const RenderOptions& options = {});

}  // namespace sundog
