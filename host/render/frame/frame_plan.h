// Plans a frame: checks its options, then creates its film, passes, tiles and workers. Internal to the render
// layer.
#pragma once
#include <memory>
#include <vector>

#include "compile/compiled_scene.h"
#include "render/frame/frame.h"
#include "render/frame/result.h"

namespace sundog {

/// Throws UsageError for options that no frame of the scene supports, DeviceError without devices.
void check_frame(const CompiledScene& scene, const std::vector<WorkerPlan>& devices,
                 const RenderOptions& options);

/// Creates a frame with its plan of passes and tiles and its workers. No pass has begun.
std::shared_ptr<Frame> plan_frame(const CompiledScene& scene, const std::vector<WorkerPlan>& devices,
                                  const RenderOptions& options);

}  // namespace sundog
