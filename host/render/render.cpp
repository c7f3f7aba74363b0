// Plans a worker for each device, and renders the frame with them.
#include "render/render.h"

#include "render/frame/frame.h"
#include "render/frame/local_worker.h"

namespace sundog {

RenderResult render(const CompiledScene& scene, const std::vector<DeviceInfo>& devices,
                    const RenderOptions& options) {
  const std::shared_ptr<const CompiledScene> borrowed(std::shared_ptr<const CompiledScene>(), &scene);
  return render_frame(scene, plan_local_workers(borrowed, devices), options, true);
}

RenderResult render(const std::shared_ptr<const CompiledScene>& scene, const std::vector<DeviceInfo>& devices,
                    const RenderOptions& options) {
  return render_frame(*scene, plan_local_workers(scene, devices), options, false);
}

}  // namespace sundog
