// Plans a worker for each device, and renders the frame with them.
#include "render/render.h"

#include "render/device/local_worker.h"
#include "render/frame/frame_loop.h"

namespace sundog {
namespace {

using Scene = std::shared_ptr<const CompiledScene>;

/// Plans a worker for each device of this process.
std::vector<WorkerPlan> plan_workers(const Scene& scene, const std::vector<DeviceInfo>& devices) {
  std::vector<WorkerPlan> plans;
  for (const DeviceInfo& device : devices) plans.push_back(plan_local(scene, device));
  return plans;
}

}  // namespace

RenderResult render(const CompiledScene& scene, const std::vector<DeviceInfo>& devices,
                    const RenderOptions& options) {
  const Scene borrowed(Scene(), &scene);
  return render_frame(scene, plan_workers(borrowed, devices), options, true);
}

RenderResult render(const std::shared_ptr<const CompiledScene>& scene, const std::vector<DeviceInfo>& devices,
                    const RenderOptions& options) {
  return render_frame(*scene, plan_workers(scene, devices), options, false);
}

}  // namespace sundog
