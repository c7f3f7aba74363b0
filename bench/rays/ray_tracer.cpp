// Builds entry/trace_rays.cl with the scene's configuration, and times runs by the device's clock.
#include "bench/rays/ray_tracer.h"

#include <algorithm>

#include "render/device/kernel_config.h"

namespace sundog {
namespace {

std::size_t divide_up(std::size_t a, std::size_t b) { return (a + b - 1) / b; }

}  // namespace

RayTracer::RayTracer(Device& device, const CompiledScene& scene, const KernelDefines& extra)
    : device_(device), tables_(upload_scene(device, scene)) {
  const KernelConfig config = make_kernel_config(scene, device.info());
  KernelDefines defines = config.defines();
  for (const auto& [name, value] : extra) defines[name] = value;
  batch_ = config.tile_w * config.tile_h;
  stack_limit_ = greatest_work_group(config, device.info());
  const Program program = device.build("entry/trace_rays.cl", defines);
  trace_rays_ = scene_kernel<Buffer<Ray>, Buffer<Hit>, u32, u32>(program, "trace_rays");
  occluded_rays_ = scene_kernel<Buffer<Ray>, Buffer<u32>, u32, u32>(program, "occluded_rays");
}

void RayTracer::upload(std::span<const Ray> rays) {
  rays_ = device_.upload(rays);
  hits_ = device_.make<Hit>(rays.size());
  occluded_ = device_.make<u32>(rays.size());
}

double RayTracer::run(const RayQuery& query, const WorkGroup& group) {
  std::size_t local = std::min<std::size_t>(device_.info().device_class == DeviceClass::cpu ? 16 : 64,
                                            std::max<std::size_t>(1, greatest_group(query.any)));
  if (group.kind != WorkGroup::Kind::automatic) local = group.kind == WorkGroup::Kind::driver ? 0 : group.x;
  const LaunchSize size{divide_up(rays_.count, batch_), 1, local, 1};
  const auto count = static_cast<u32>(rays_.count);
  const u32 coherent = query.coherent ? 1 : 0;
  if (query.any)
    run_scene_kernel(device_, occluded_rays_, size, tables_, rays_, occluded_, count, coherent);
  else
    run_scene_kernel(device_, trace_rays_, size, tables_, rays_, hits_, count, coherent);
  const auto seconds = [&] {
    const auto times = device_.times().find(query.any ? occluded_rays_.name : trace_rays_.name);
    return times == device_.times().end() ? 0 : 1e-3 * times->second.device_ms;
  };
  const double before = seconds();
  device_.finish();
  return seconds() - before;
}

std::size_t RayTracer::greatest_group(bool any) const {
  const std::size_t kernels =
      any ? device_.limits(occluded_rays_).work_group : device_.limits(trace_rays_).work_group;
  return stack_limit_ > 0 ? std::min(stack_limit_, kernels) : kernels;
}

std::vector<Hit> RayTracer::hits() {
  std::vector<Hit> result(hits_.count);
  device_.read(hits_, std::span<Hit>(result));
  return result;
}

std::vector<u32> RayTracer::occluded() {
  std::vector<u32> result(occluded_.count);
  device_.read(occluded_, std::span<u32>(result));
  return result;
}

std::vector<Hit> RayTracer::trace(std::span<const Ray> rays, bool coherent) {
  upload(rays);
  run({false, coherent});
  return hits();
}

std::vector<u32> RayTracer::occlusion(std::span<const Ray> rays, bool coherent) {
  upload(rays);
  run({true, coherent});
  return occluded();
}

}  // namespace sundog
