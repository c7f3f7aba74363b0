// The kernels of a frame on one device, built for its scene, and the scene's tables.
#pragma once
#include <string>
#include <vector>

#include "render/device/device_scene.h"
#include "render/device/kernel_store.h"
#include "render/values/options.h"
#include "render/values/report.h"
#include "shared/launch.h"

namespace sundog {

using IntegratorKernel =
    SceneKernel<Buffer<u32>, Buffer<u32>, Buffer<float4>, Buffer<float>, Buffer<u32>, Buffer<u32>, Launch>;
using PhotonKernel = SceneKernel<Buffer<u32>, Buffer<float4>, Buffer<u32>, PhotonLaunch>;

struct FrameKernels {
  KernelConfig config;
  DeviceScene tables;
  IntegratorKernel integrator;
  SceneKernel<Buffer<u32>, Buffer<u32>, Buffer<float4>, Buffer<u32>, u32, u32, u32, u32, u32>
      first_surfaces;          // with AOVs
  PhotonKernel trace_photons;  // with caustics
  struct MoreAovs {
    bool all = false, features = false;  // vectors
    friend bool operator==(const MoreAovs&, const MoreAovs&) = default;
  } wanted_aovs, there_aovs;  // AOVs of first_surfaces
  bool mattes = false;        // the integrator records which objects cover pixels,
  bool light = false;         // separates their light by parts,
  bool groups = false;        // or by light groups
  bool counts_rays = false;   // the integrator counts rays per pixel
  KernelChoice choice = KernelChoice::own;
  SceneKernel<Buffer<u32>> find_media;  // built once the camera has been inside a solid
  std::string entry;                    // the integrator's kernel file
  bool camera_inside = false;           // tables.camera_media differ from those outside all solids
  unsigned most_run = 1;                // items that a work-item of the integrator can process
  std::size_t most_group = 0;           // maximum work-group size; 0: unknown
  std::vector<std::string> notes;       // why a cache was not usable
  KernelStore* store = nullptr;         // supplies stand-ins while the scene's kernels are built; null: none
};

IntegratorKernel integrator_kernel(const Program& program, const std::string& name);

/// Whether the frame's kernels still have to be built on the device, while its draft's kernels are cached.
bool has_only_draft(const DeviceInfo& info, const CompiledScene& scene, const Tuning& tuning);

/// The result of an update.
struct KernelUpdate {
  UploadFigures uploads;
  unsigned built = 0;    // programs compiled by the driver
  bool changed = false;  // the kernels have changed
};

/// Builds the integrator's kernel and, with `aovs`, the AOV kernel; uploads the scene and determines the
/// media around the camera; fills `times`. `kernels` is empty or was built on this device for another scene:
/// then only kernels whose definitions differ are built, and only tables that differ are written. After an
/// exception it is invalid. Throws DeviceError, BuildError; UsageError if the requested work-group is not
/// possible.
KernelUpdate update_frame_kernels(Device& device, const CompiledScene& scene, const Tuning& tuning,
                                  const WorkGroup& asked, bool aovs, FrameKernels& kernels,
                                  RenderTimes& times);

/// Switches from bit-exact stand-ins to the integrator's own kernel, if it has been built meanwhile. Returns
/// whether it did.
bool take_wanted_kernel(Device& device, FrameKernels& kernels);

/// Builds the photon kernel if missing.
void add_photon_tracer(Device& device, FrameKernels& kernels, RenderTimes& times);

/// Work-group size of the photon kernel.
std::size_t photon_group(const KernelConfig& config, std::size_t most_group);

/// Builds the AOV kernel if missing.
void add_first_surfaces(Device& device, FrameKernels& kernels, RenderTimes& times);

}  // namespace sundog
