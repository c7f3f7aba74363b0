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
      first_surfaces;          // only with AOVs
  PhotonKernel trace_photons;  // only with caustics
  struct MoreAovs {
    bool all = false, features = false;  // vectors
    friend bool operator==(const MoreAovs&, const MoreAovs&) = default;
  } wanted_aovs, there_aovs;  // of first_surfaces
  bool mattes = false;        // the integrator notes what covers pixels
  bool light = false;         // and keeps the parts of their light apart,
  bool groups = false;        // or that of groups of lights
  bool counts_rays = false;   // the integrator counts rays per pixel
  KernelChoice choice = KernelChoice::own;
  SceneKernel<Buffer<u32>> find_media;  // only if the camera has been inside a solid
  std::string entry;                    // of the integrator
  bool camera_inside = false;           // tables.camera_media are not the outside's
  unsigned most_run = 1;                // items that a work-item of the integrator can process
  std::size_t most_group = 0;           // maximum work-group size; 0: unknown
  std::vector<std::string> notes;       // why a cache was not usable
  KernelStore* store = nullptr;         // others may draw while the scene's are built; null: they do not
};

IntegratorKernel integrator_kernel(const Program& program, const std::string& name);

/// Whether the frame's kernels must be built on the device, while those of its draft are in its cache.
bool has_only_draft(const DeviceInfo& info, const CompiledScene& scene, const Tuning& tuning);

/// The result of an update.
struct KernelUpdate {
  UploadFigures uploads;
  unsigned built = 0;    // programs compiled by the driver
  bool changed = false;  // the kernels have changed
};

/// Builds the integrator's kernel and, with `aovs`, the AOV kernel; uploads the scene and determines the
/// media around the camera; fills `times`. `kernels` are empty or built on this device for another scene:
/// then only kernels whose definitions differ are built, and only tables that differ written. After an
/// exception they are invalid. Throws DeviceError, BuildError; UsageError if the requested group is not
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
