// One device at work on a frame: its kernels, its copy of the scene, and the launches that make a tile.
#pragma once
#include <atomic>
#include <vector>

#include "render/device_scene.h"
#include "render/film.h"
#include "render/kernel_config.h"
#include "render/launch_watch.h"
#include "render/render.h"
#include "render/tile_server.h"

namespace sundog {

class TileRenderer {
 public:
  /// Builds the kernels and uploads the scene; fills `times`. Each launch is told to `watch`. Throws
  /// DeviceError, BuildError.
  TileRenderer(Device& device, const CompiledScene& scene, const RenderOptions& options, RenderTimes& times,
               LaunchWatch& watch);

  /// Renders all samples of a tile in launches of bounded time. Where the device runs out of memory or
  /// resources, once more in launches of half the size, and so on; where its driver ended the kernel's loops
  /// early, in launches of half the samples, at last in work-groups of one; where a work-group is too large
  /// for it, in groups of half the size. Throws DeviceError.
  TileResult render(const Tile& tile, const StopFlags& flags);

  /// Most work-items that a group of its kernels may have; 0: nobody says.
  std::size_t greatest_group() const { return most_group_; }
  double readback_seconds() const { return readback_seconds_; }
  /// What did not stop it: a cache that could not be used, launches that had to be made smaller.
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  void find_camera_media();
  Program build(const char* entry, RenderTimes& times);
  TileResult try_render(const Tile& tile, const StopFlags& flags);
  bool shrink(const std::string& why);
  bool shrink_group(const std::string& why, std::size_t least);
  void limit_groups();
  bool ask_less(const std::string& why);
  void check_finished(const Tile& asked, const TileResult& made);
  unsigned launch_samples(const Tile& tile, const StopFlags& flags);
  void note_time(std::size_t size, double seconds);
  void launch_aovs(const Tile& tile, std::vector<float4>& aovs);
  LaunchSize launch_size(std::size_t columns, std::size_t rows) const;
  const WorkGroup& work_group() const;

  Device& device_;
  const CompiledScene& scene_;
  const RenderOptions& options_;
  Tuning tuning_;
  KernelConfig config_;
  DeviceScene tables_;
  SceneKernel<Buffer<u32>, Buffer<float4>, Buffer<float>, Buffer<u32>, u32, u32, u32, u32, u32, u32, u32, u32,
              u32>
      render_;
  SceneKernel<Buffer<u32>, Buffer<float4>, Buffer<u32>, u32, u32, u32, u32> first_surfaces_;
  bool aovs_launched_ = false;
  Buffer<float4> film_;
  Buffer<float> weights_;
  Buffer<float4> aovs_;
  Buffer<u32> counters_;
  LaunchWatch& watch_;
  std::size_t next_size_;                         // pixel-samples of the next launch
  std::size_t last_size_ = 0;                     // of the last one
  std::size_t least_size_ = 0;                    // of any, in the tile in hand
  std::size_t most_size_ = std::size_t{1} << 30;  // less where the device ran out of resources
  std::size_t most_group_ = 0;                    // work-items of a group; 0: nobody says
  std::size_t last_group_ = 0;                    // of the last launch; 0: the driver's choice
  unsigned most_samples_ = ~0u;                   // of a launch; less where the driver ended loops early
  unsigned last_samples_ = 0;                     // the most of any launch, in the tile in hand
  bool alone_ = false;                            // work-groups of one
  double pixel_seconds_ = 0;                      // a pixel-sample's, by the last launch; 0: unknown
  double readback_seconds_ = 0;
  std::vector<std::string> notes_;
};

}  // namespace sundog
