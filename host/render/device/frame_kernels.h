// The kernels of a frame on one device, built for its scene, and the scene's tables there.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "render/device/device_scene.h"
#include "render/device/kernel_builder.h"
#include "render/device/kernel_config.h"
#include "render/values/options.h"
#include "render/values/report.h"
#include "shared/launch.h"

namespace sundog {

/// The scene was replaced while its kernels were being built. The previous kernels are unchanged.
struct NotWantedAnyMore : DeviceError {
  using DeviceError::DeviceError;
};

using PhotonKernel = SceneKernel<Buffer<u32>, Buffer<float4>, Buffer<u32>, PhotonLaunch>;

struct FrameKernels {
  KernelConfig config;
  DeviceScene tables;
  SceneKernel<Buffer<u32>, Buffer<u32>, Buffer<float4>, Buffer<float>, Buffer<u32>, Buffer<u32>, Launch>
      integrator;
  SceneKernel<Buffer<u32>, Buffer<u32>, Buffer<float4>, Buffer<u32>, u32, u32, u32, u32, u32>
      first_surfaces;          // only with AOVs
  PhotonKernel trace_photons;  // only with caustics
  struct MoreAovs {
    bool all = false, features = false;  // vectors
    friend bool operator==(const MoreAovs&, const MoreAovs&) = default;
  } wanted_aovs, there_aovs;                // of first_surfaces
  bool counts_rays = false;                 // of the integrator: those of each pixel
  bool only_general = false;                // general_config() even where the scene's could be built
  SceneKernel<Buffer<u32>> find_media;      // only where the camera has been inside a solid
  std::string entry;                        // of the integrator
  bool camera_inside = false;               // tables.camera_media are not those of the outside
  unsigned most_run = 1;                    // items that a work-item of the integrator can take
  std::size_t most_group = 0;               // the largest work-group that they allow; 0: unknown
  std::vector<std::string> notes;           // why a cache could not be used
  KernelBuilder* builder = nullptr;         // builds while other kernels draw; may be null
  std::vector<KernelConfig> known;          // that this device has built
  std::optional<KernelConfig> wanted;       // being built, while others stand in
  bool is_draft = false;                    // those that stand in round otherwise
  std::vector<KernelConfig> general;        // with a builder: those that stand in for the scene's
  std::vector<KernelConfig> built_general;  // those of them that are known to be built
};

/// Builds the integrator's kernel, with `aovs` that of the AOVs too, uploads the scene and finds out which
/// media the camera is in; fills `times`. Throws DeviceError, BuildError; UsageError when the group asked for
/// cannot be had.
FrameKernels build_frame_kernels(Device& device, const CompiledScene& scene, const Tuning& tuning,
                                 const WorkGroup& asked, bool aovs, RenderTimes& times);

/// What an update has made.
struct KernelUpdate {
  UploadFigures uploads;
  unsigned built = 0;    // programs, by the driver's compiler
  bool changed = false;  // other kernels than before
};

/// Brings `kernels`, which build_frame_kernels() made on this device, to another scene: builds only what
/// other definitions want, writes only the tables that differ. After an exception they are of no use.
KernelUpdate update_frame_kernels(Device& device, const CompiledScene& scene, const Tuning& tuning,
                                  const WorkGroup& asked, bool aovs, FrameKernels& kernels,
                                  RenderTimes& times);

/// Queues the general kernels (general_configs()), which draw while an edit's own kernels are built. Without
/// a builder it does nothing.
void build_general_kernels(const Device& device, FrameKernels& kernels);

/// Takes the integrator's kernel that others stand in for to the bit, if it has been built meanwhile. Returns
/// whether it did.
bool take_wanted_kernel(Device& device, FrameKernels& kernels);

/// Whether the kernels that are wanted in place of a draft's have been built, or failed to.
bool may_end_draft(const FrameKernels& kernels);

/// Builds the kernel of photons where it is missing.
void add_photon_tracer(Device& device, FrameKernels& kernels, RenderTimes& times);

/// Work-items of its groups.
std::size_t photon_group(const KernelConfig& config, std::size_t most_group);

/// Builds the kernel of the AOVs where it is missing.
void add_first_surfaces(Device& device, FrameKernels& kernels, RenderTimes& times);

}  // namespace sundog
