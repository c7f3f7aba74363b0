// Plans a worker for each device, runs the frame once, and returns its film and figures.
#include "render/render.h"

#include "render/device/local_worker.h"
#include "render/frame/frame.h"
#include "render/frame/frame_loop.h"

namespace sundog {
namespace {

using Scene = std::shared_ptr<const CompiledScene>;

RenderResult render_once(const CompiledScene& scene, const std::vector<WorkerPlan>& devices,
                         const RenderOptions& options, bool wait) {
  const std::shared_ptr<Frame> frame = begin_frame(scene, devices, options);
  run_frame(frame, wait);
  return finish_frame(*frame);
}

/// Plans a worker for each device of this process.
std::vector<WorkerPlan> plan_workers(const Scene& scene, const std::vector<DeviceInfo>& devices) {
  std::vector<WorkerPlan> plans;
  for (const DeviceInfo& device : devices) plans.push_back(plan_local(scene, device));
  return plans;
}

}  // namespace

WorkerPlan plan_local(Scene scene, const DeviceInfo& device) {
  return {device, device.shares_cores() ? 0 : -1,
          [scene = std::move(scene), device](const RenderOptions& options) {
            return std::make_shared<LocalWorker>(device, scene, options);
          }};
}

RenderResult render(const CompiledScene& scene, const std::vector<DeviceInfo>& devices,
                    const RenderOptions& options) {
  const Scene borrowed(Scene(), &scene);
  return render_once(scene, plan_workers(borrowed, devices), options, true);
}

RenderResult render(const std::shared_ptr<const CompiledScene>& scene, const std::vector<DeviceInfo>& devices,
                    const RenderOptions& options) {
  return render_once(*scene, plan_workers(scene, devices), options, false);
}

RenderResult render(const std::shared_ptr<const CompiledScene>& scene, const std::vector<WorkerPlan>& workers,
                    const RenderOptions& options) {
  return render_once(*scene, workers, options, false);
}

}  // namespace sundog
