#include "render/device/frame_kernels.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/clock.h"
#include "base/error.h"
#include "scene/integrators.h"

namespace sundog {
namespace {

void check_work_group(const DeviceInfo& device, std::size_t most, const WorkGroup& group) {
  if (group.kind == WorkGroup::Kind::fixed && most > 0 && group.x * group.y > most)
    throw UsageError(
        fmt::format("{}: a work-group of {} is more than the {} that it can have in this scene; ask for "
                    "less, or for a smaller max_depth",
                    device.label(), group.x * group.y, most));
}

Program build(Device& device, const char* entry, FrameKernels& kernels, RenderTimes& times) {
  BuildReport report;
  Program program = device.build(entry, kernels.config.defines, &report, kernels.config.generated);
  times.cached = times.cached && report.cached;
  if (!report.note.empty()) kernels.notes.push_back("no kernel cache: " + report.note);
  return program;
}

/// The kernels' own limits are known once they are built: theirs are what a group's registers suffice for.
void limit_group(std::size_t limit, std::size_t& most) {
  if (limit > 0) most = most > 0 ? std::min(most, limit) : limit;
}

void find_camera_media(Device& device, FrameKernels& kernels) {
  auto kernel = scene_kernel<Buffer<u32>>(
      device.build("entry/camera_media.cl", kernels.config.defines, nullptr, kernels.config.generated),
      "find_camera_media");
  run_scene_kernel<Buffer<u32>>(device, kernel, {1, 1, 1, 1}, kernels.tables, kernels.tables.camera_media);
  device.finish();
}

}  // namespace

FrameKernels build_frame_kernels(Device& device, const CompiledScene& scene, const Tuning& tuning,
                                 const WorkGroup& asked, bool aovs, RenderTimes& times) {
  FrameKernels kernels;
  kernels.config = make_kernel_config(scene, device.info(), tuning);
  kernels.most_group = greatest_work_group(kernels.config, device.info());
  check_work_group(device.info(), kernels.most_group, asked);
  const Stopwatch building;
  times.cached = true;
  const Integrator& integrator = *find_integrator(scene.integrator);
  kernels.integrator =
      scene_kernel<Buffer<u32>, Buffer<u32>, Buffer<float4>, Buffer<float>, Buffer<u32>, Launch>(
          build(device, integrator.entry, kernels, times), integrator.kernel);
  limit_group(device.limits(kernels.integrator).work_group, kernels.most_group);
  if (aovs) {
    kernels.first_surfaces =
        scene_kernel<Buffer<u32>, Buffer<u32>, Buffer<float4>, Buffer<u32>, u32, u32, u32, u32, u32>(
            build(device, "entry/aov.cl", kernels, times), "first_surfaces");
    limit_group(device.limits(kernels.first_surfaces).work_group, kernels.most_group);
  }
  check_work_group(device.info(), kernels.most_group, asked);
  times.build_kernels = building.seconds();
  const Stopwatch uploading;
  kernels.tables = upload_scene(device, scene);
  times.upload = uploading.seconds();
  if (integrator.needs_camera_media && scene.features.camera_inside) find_camera_media(device, kernels);
  return kernels;
}

}  // namespace sundog
