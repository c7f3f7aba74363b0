// One device that renders one scene again and again, for timing whole frames.
#pragma once
#include <memory>

#include "render/device/tile_renderer.h"
#include "render/film/film.h"
#include "render/plan/plan.h"
#include "render/render.h"

namespace sundog {

/// Kernels are built and tables uploaded once. The scene must outlive it.
class FrameRunner {
 public:
  /// Throws DeviceError, BuildError, UsageError as render() does.
  FrameRunner(const DeviceInfo& device, const CompiledScene& scene, const RenderOptions& options = {});
  FrameRunner(const FrameRunner&) = delete;
  FrameRunner& operator=(const FrameRunner&) = delete;

  /// Renders the frame in the tiles that `sundog render` would take, and returns the wall seconds from the
  /// first launch until the film is on the host.
  double run();

  /// For the runs from now on. The size must be one that render() would take.
  void use(const WorkGroup& group) { options_.work_group = group; }

  /// Most work-items that a group of its kernels may have; 0: nobody says.
  std::size_t greatest_group() const { return renderer_->greatest_group(); }

  /// Keeps what the driver has compiled so far for other programs and the next start.
  void save_programs() { device_.save_programs(); }

  /// Of the last run: on the device, of all launches of a kernel; by the host's clock where the driver gives
  /// no times.
  double kernel_seconds(const std::string& kernel) const;
  /// Of the last run, for each kernel.
  const std::map<std::string, KernelTimes>& kernel_times() const { return device_.times(); }
  const Film& film() const { return film_; }
  Image image() const { return film_.develop(); }
  const RayCounts& counts() const { return counts_; }

  /// Kernels and tables; not part of any run.
  const RenderTimes& times() const { return times_; }

 private:
  std::vector<Tile> tiles() const;

  Device device_;
  RenderOptions options_;
  LaunchWatch watch_;
  DeviceSpeed speed_;
  Film film_;
  RayCounts counts_{};
  RenderTimes times_;
  std::unique_ptr<TileRenderer> renderer_;
};

}  // namespace sundog
