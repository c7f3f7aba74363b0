// See frame_runner.h.
#include "bench/frame_runner.h"

#include "base/clock.h"
#include "render/tiles.h"

namespace sundog {

FrameRunner::FrameRunner(const DeviceInfo& device, const CompiledScene& scene, const RenderOptions& options)
    : device_(device),
      options_(options),
      film_(static_cast<int>(scene.info.width), static_cast<int>(scene.info.height), !options.aovs.empty()) {
  const int edge = options.tile > 0 ? options.tile : default_tile_edge(film_.width, film_.height, 1);
  tiles_ = cut_tiles(film_.width, film_.height, edge);
  renderer_ = std::make_unique<TileRenderer>(device_, scene, options_, times_);
}

double FrameRunner::run() {
  const Stopwatch clock;
  counts_.fill(0);
  for (const Tile& tile : tiles_) {
    const TileResult result = renderer_->render(tile);
    film_.put(result.tile, result.sums, result.weights, result.aovs);
    for (std::size_t i = 0; i < COUNTERS; ++i) counts_[i] += result.counts[i];
  }
  return clock.seconds();
}

}  // namespace sundog
