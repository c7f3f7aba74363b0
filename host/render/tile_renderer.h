// One device at work on a frame: its kernels, its copy of the scene, and the launches that make a tile.
#pragma once
#include <atomic>
#include <vector>

#include "render/device_scene.h"
#include "render/film.h"
#include "render/kernel_config.h"
#include "render/render.h"

namespace sundog {

/// A tile's pixels and ray counts. `tile` is what was finished: less rows than asked for when it was stopped
/// on the way.
struct TileResult {
  Tile tile;
  std::vector<float4> sums;
  std::vector<float> weights;
  std::vector<float4> aovs;
  RayCounts counts{};
};

class TileRenderer {
 public:
  /// Builds the kernels and uploads the scene; fills `times`. Throws DeviceError, BuildError.
  TileRenderer(Device& device, const CompiledScene& scene, const RenderOptions& options, RenderTimes& times);

  /// Renders all samples of a tile in launches of bounded time. Throws DeviceError.
  TileResult render(const Tile& tile);

  double readback_seconds() const { return readback_seconds_; }

 private:
  void find_camera_media();
  unsigned launch_samples(const Tile& tile, const std::atomic<bool>* stop);
  void launch_aovs(const Tile& tile, std::vector<float4>& aovs);
  LaunchSize launch_size(std::size_t columns, std::size_t rows) const;

  Device& device_;
  const CompiledScene& scene_;
  const RenderOptions& options_;
  KernelConfig config_;
  DeviceScene tables_;
  SceneKernel<Buffer<u32>, Buffer<float4>, Buffer<float>, Buffer<u32>, u32, u32, u32, u32, u32, u32, u32, u32,
              u32>
      render_;
  SceneKernel<Buffer<u32>, Buffer<float4>, u32, u32, u32, u32> first_surfaces_;
  Buffer<float4> film_;
  Buffer<float> weights_;
  Buffer<float4> aovs_;
  Buffer<u32> counters_;
  std::size_t next_size_;  // pixel-samples of the next launch
  double readback_seconds_ = 0;
};

}  // namespace sundog
