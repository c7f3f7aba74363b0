#include "render/render.h"

#include "render/device/device_server.h"
#include "render/session/final_frame.h"

namespace sundog {
namespace {

using Scene = std::shared_ptr<const CompiledScene>;

RenderResult render_once(const Scene& scene, const std::vector<ServerPlan>& devices,
                         const RenderOptions& options, bool wait) {
  return render_frame(scene, devices, options,
                      [wait](const std::shared_ptr<Frame>& frame) { run_frame(frame, wait); });
}

/// Devices of this process.
std::vector<ServerPlan> plan_servers(const Scene& scene, const std::vector<DeviceInfo>& devices) {
  std::vector<ServerPlan> plans;
  for (const DeviceInfo& device : devices) plans.push_back(plan_local(scene, device));
  return plans;
}

}  // namespace

ServerPlan plan_local(Scene scene, const DeviceInfo& device) {
  return {device, device.type == "cpu" ? 0 : -1,
          [scene = std::move(scene), device](const RenderOptions& options) {
            return std::make_shared<DeviceServer>(device, scene, options);
          }};
}

RenderResult render(const CompiledScene& scene, const std::vector<DeviceInfo>& devices,
                    const RenderOptions& options) {
  const Scene borrowed(Scene(), &scene);
  return render_once(borrowed, plan_servers(borrowed, devices), options, true);
}

RenderResult render(const std::shared_ptr<const CompiledScene>& scene, const std::vector<DeviceInfo>& devices,
                    const RenderOptions& options) {
  return render_once(scene, plan_servers(scene, devices), options, false);
}

RenderResult render(const std::shared_ptr<const CompiledScene>& scene, const std::vector<ServerPlan>& servers,
                    const RenderOptions& options) {
  return render_once(scene, servers, options, false);
}

}  // namespace sundog
