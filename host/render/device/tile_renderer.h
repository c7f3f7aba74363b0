// One device at work on a frame: launches that make a tile, run in turn, and what is done when one fails.
#pragma once
#include <vector>

#include "render/device/frame_kernels.h"
#include "render/device/launch_sizer.h"
#include "render/device/launch_watch.h"
#include "render/device/photon_maps.h"
#include "render/film/film.h"
#include "render/frame/tile_server.h"
#include "render/values/options.h"
#include "render/values/report.h"

namespace sundog {

class TileRenderer {
 public:
  /// Builds the kernels and uploads the scene; fills `times`. Reports each launch to `watch`. Where options
  /// allow it, `builder` builds kernels beside the work while others stand in for them. Throws DeviceError,
  /// BuildError.
  TileRenderer(Device& device, const CompiledScene& scene, const RenderOptions& options, RenderTimes& times,
               LaunchWatch& watch, KernelBuilder* builder = nullptr);

  /// Draws another scene from now on: keeps the kernels and tables that suit it, and builds and uploads the
  /// others. `options` must outlive it. After an exception it is of no use. Throws as the constructor does.
  void change_scene(const CompiledScene& scene, const RenderOptions& options, RenderTimes& times);

  /// Keeps what the driver has compiled so far for the next start.
  void keep_programs();

  /// Called when nothing is to be drawn: keeps what was compiled, and has general kernels built.
  void rest();

  /// Builds the kernel of the AOVs where it is missing, for requests of passes that ask for surfaces.
  void prepare_surfaces();

  /// Renders what is asked for of a tile in launches of bounded time. Where the device runs out of memory or
  /// resources, once more in launches of half the size, and so on; where its driver ended the kernel's loops
  /// early, in launches of half the samples, at last in work-groups of one; where a work-group is too large
  /// for it, in groups of half the size. Throws DeviceError.
  TileResult render(const TileRequest& request, const StopFlags& flags);
  /// The same of a plain frame's tile.
  TileResult render(const Tile& tile, const StopFlags& flags) {
    TileRequest request;
    request.tile = tile;
    return render(request, flags);
  }

  /// What the constructor or the last change_scene() has built and uploaded.
  const KernelUpdate& update() const { return update_; }
  /// What its kernels are specialised to: it changes before a tile, when better ones have been built.
  const KernelConfig& config() const { return kernels_.config; }
  /// It draws what other kernels have to draw anew, and whether those are there.
  bool draws_draft() const { return kernels_.is_draft; }
  bool may_end_draft() const { return sundog::may_end_draft(kernels_); }
  /// The largest work-group that its kernels allow; 0: unknown.
  std::size_t greatest_group() const { return sizer_.most_group(); }
  double readback_seconds() const { return readback_seconds_; }
  /// What did not stop it: a cache that could not be used, launches that had to be made smaller.
  const std::vector<std::string>& notes() const { return kernels_.notes; }

 private:
  TileResult try_render(const TileRequest& request, const StopFlags& flags);
  void write_start(const TileRequest& request, TileResult& result);
  void read_result(unsigned samples, TileResult& result);
  unsigned launch_samples(const TileRequest& request, const StopFlags& flags);
  double launch_integrator(const Launch& launch, const SizedLaunch& sized);
  void launch_aovs(const TileRequest& request, const Tile& tile, std::vector<float4>& aovs);
  void check_finished(const TileRequest& asked, const TileResult& made);
  unsigned samples_of(const TileRequest& request) const {
    return request.in_pass ? request.sample_count : samples_;
  }
  bool wants_aovs(const TileRequest& request) const {
    return request.in_pass ? request.surfaces : show_surfaces(options_->aovs);
  }

  Device& device_;
  const RenderOptions* options_;
  KernelBuilder* builder_;
  bool marches_;  // the scene has fields
  unsigned samples_;
  Tuning tuning_;
  WorkGroup asked_;
  FrameKernels kernels_;
  KernelUpdate update_;
  PhotonMaps photons_;
  LaunchSizer sizer_;
  LaunchWatch& watch_;
  bool aovs_launched_ = false;
  Buffer<u32> pixels_;
  Buffer<float4> film_;
  Buffer<float> weights_;
  Buffer<float4> aovs_;
  Buffer<u32> rays_;  // of each pixel, where they are asked for; else of one
  Buffer<u32> counters_;
  double readback_seconds_ = 0;
};

}  // namespace sundog
