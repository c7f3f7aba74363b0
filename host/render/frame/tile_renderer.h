// Renders tiles on one device: sequences of launches, and recovery from failed ones.
#pragma once
#include <vector>

#include "render/device/frame_kernels.h"
#include "render/device/launch_watch.h"
#include "render/device/photon_maps.h"
#include "render/film/film.h"
#include "render/frame/device_worker.h"
#include "render/frame/launch_sizer.h"
#include "render/values/options.h"
#include "render/values/report.h"

namespace sundog {

class TileRenderer {
 public:
  /// Builds the kernels and uploads the scene; fills `times`. Reports each launch to `watch`. If the options
  /// allow it, `store` builds kernels in the background while others stand in. Throws DeviceError,
  /// BuildError.
  TileRenderer(Device& device, const CompiledScene& scene, const RenderOptions& options, RenderTimes& times,
               LaunchWatch& watch, KernelStore* store = nullptr);

  /// Switches to another scene: keeps suitable kernels and tables, builds and uploads the others. Unusable
  /// after an exception. Throws like the constructor.
  void change_scene(const CompiledScene& scene, const RenderOptions& options, RenderTimes& times);

  /// Writes the driver's compiled programs to the cache for the next start.
  void keep_programs();

  /// Call when idle: caches compiled programs, and starts building general kernels.
  void rest();

  /// Builds the AOV kernel if missing, for passes that request surfaces.
  void prepare_surfaces();

  /// Renders a tile request in launches of bounded time. If the device runs out of memory or resources,
  /// retries with launches of half the size, repeatedly; if its driver ended loops early, with half the
  /// samples, finally in work-groups of one; if a work-group is too large, with half the group size. Throws
  /// DeviceError.
  TileResult render(const TileRequest& request, const StopFlags& flags);

  /// Statistics of the constructor or the last change_scene().
  const KernelUpdate& update() const { return update_; }
  /// The specialisation of its kernels; changes before a tile when better ones have been built.
  const KernelConfig& config() const { return kernels_.config; }
  /// Whether the picture must be drawn again by other kernels.
  bool draws_draft() const { return kernels_.store && kernels_.store->draws_draft(); }
  /// Maximum work-group size of its kernels; 0: unknown.
  std::size_t greatest_group() const { return sizer_.most_group(); }
  double readback_seconds() const { return readback_seconds_; }
  /// Warnings: an unusable cache, launches that had to be reduced.
  const std::vector<std::string>& notes() const { return kernels_.notes; }

 private:
  TileResult try_render(const TileRequest& request, const StopFlags& flags);
  void write_start(const TileRequest& request, TileResult& result);
  std::uint64_t count_lost_pixels(std::size_t pixels);
  void read_result(unsigned samples, TileResult& result);
  unsigned launch_samples(const TileRequest& request, const StopFlags& flags);
  double launch_integrator(const Launch& launch, const SizedLaunch& sized);
  void write_sums(const TileRequest& request);
  void read_aovs(const TileRequest& request, TileResult& result);
  void look_at_surfaces(const TileRequest& request, TileResult& result);
  void check_finished(const TileRequest& asked, const TileResult& made);

  Device& device_;
  KernelStore* store_;
  bool marches_;  // the scene has fields
  Tuning tuning_;
  WorkGroup asked_;
  FrameKernels kernels_;
  KernelUpdate update_;
  PhotonMaps photons_;
  LaunchSizer sizer_;
  LaunchWatch& watch_;
  AovLayout layout_;  // for the options' AOVs
  bool aovs_launched_ = false;
  Buffer<u32> pixels_;
  Buffer<float4> film_;  // the sums of a tile's pixels, then their AOV sums
  Buffer<float> weights_;
  Buffer<float4> aovs_;
  Buffer<u32> rays_;          // per pixel, with LOST_PIXEL
  std::vector<u32> no_rays_;  // zeros, for passes that do not count rays
  Buffer<u32> counters_;
  double readback_seconds_ = 0;
};

}  // namespace sundog
