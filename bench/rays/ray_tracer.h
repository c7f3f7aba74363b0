// Traces given rays through a compiled scene on a device, for benchmarks and tests of the tracer alone.
#pragma once
#include <span>
#include <vector>

#include "render/device/device_scene.h"
#include "render/render.h"

namespace sundog {

/// The answer wanted, and how rays are traced. `coherent`: the 16 successive rays of a work-item run close
/// together.
struct RayQuery {
  bool any = false;  // only whether there is a hit
  bool coherent = false;
};

class RayTracer {
 public:
  /// Builds the kernels for the scene and the device's class, and uploads the scene. `extra` overrides the
  /// scene's definitions. Throws DeviceError, BuildError.
  RayTracer(Device& device, const CompiledScene& scene, const KernelDefines& extra = {});

  /// The rays that run() traces from now on.
  void upload(std::span<const Ray> rays);

  /// Traces all rays and waits for them. Work-groups have one dimension, `group.x`. Returns the kernel's
  /// seconds by the device's events; 0 if the driver gives no times.
  double run(const RayQuery& query, const WorkGroup& group = {});

  /// The largest work-group of the kernel for such rays.
  std::size_t greatest_group(bool any) const;

  /// Results of the last run() with any = false.
  std::vector<Hit> hits();
  /// Results of the last run() with any = true: 1 where something is hit, else 0.
  std::vector<u32> occluded();

  std::vector<Hit> trace(std::span<const Ray> rays, bool coherent = false);
  std::vector<u32> occlusion(std::span<const Ray> rays, bool coherent = false);

 private:
  template <class Result>
  using RayKernel = SceneKernel<Buffer<Ray>, Buffer<Result>, u32, u32>;

  Device& device_;
  unsigned batch_ = 1;           // rays a work-item traces
  std::size_t stack_limit_ = 0;  // greatest_work_group() of the configuration; 0: unknown
  DeviceScene tables_;
  RayKernel<Hit> trace_rays_;
  RayKernel<u32> occluded_rays_;
  Buffer<Ray> rays_;
  Buffer<Hit> hits_;
  Buffer<u32> occluded_;
};

/// An open device with a scene's tracer.
struct OpenedTracer {
  Device device;
  RayTracer tracer;
  OpenedTracer(const DeviceInfo& info, const CompiledScene& scene) : device(info), tracer(device, scene) {}
};

}  // namespace sundog
