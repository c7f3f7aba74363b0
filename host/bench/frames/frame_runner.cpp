// See frame_runner.h.
#include "bench/frames/frame_runner.h"

#include <fmt/format.h>

#include "base/clock.h"
#include "base/error.h"
#include "render/plan/tiles.h"

namespace sundog {

FrameRunner::FrameRunner(const DeviceInfo& device, const CompiledScene& scene, const RenderOptions& options)
    : device_(device),
      options_(options),
      film_(static_cast<int>(scene.info.width), static_cast<int>(scene.info.height), !options.aovs.empty()) {
  if (options_.tuning) speed_.tile_seconds = 1e-3 * options_.tuning(device).tile_ms;
  renderer_ = std::make_unique<TileRenderer>(device_, scene, options_, times_, watch_);
}

std::vector<Tile> FrameRunner::tiles() const {
  if (options_.tile > 0) return cut_tiles(film_.width, film_.height, options_.tile);
  return {{0, 0, film_.width, film_.height}};
}

double FrameRunner::run() {
  const Stopwatch clock;
  counts_.fill(0);
  device_.forget_times();
  WaitingTiles waiting(tiles());
  while (waiting.pixels() > 0) {
    const std::uint64_t wanted = guided_pixels(std::span(&speed_, 1), 0, waiting.pixels());
    const Tile tile = options_.tile > 0 ? *waiting.take_whole() : *waiting.take(wanted);
    const Stopwatch busy;
    const TileResult result = renderer_->render(tile, {});
    speed_.sample = static_cast<double>(pixel_count(tile));
    speed_.measured = speed_.sample / busy.seconds();
    film_.put(result.tile, result.sums, result.weights, result.aovs);
    for (std::size_t i = 0; i < COUNTERS; ++i) counts_[i] += result.counts[i];
  }
  const double seconds = clock.seconds();
  // A group that the driver refused was made smaller: the time is not that of what was asked for.
  const WorkGroup& group = options_.work_group;
  const std::size_t most = greatest_group();
  if (group.kind == WorkGroup::Kind::fixed && most > 0 && group.x * group.y > most)
    throw DeviceError(fmt::format("the driver takes groups of at most {} here", most));
  return seconds;
}

double FrameRunner::kernel_seconds(const std::string& kernel) const {
  const auto found = device_.times().find(kernel);
  if (found == device_.times().end()) return 0;
  return 1e-3 * (found->second.device_ms > 0 ? found->second.device_ms : found->second.host_ms);
}

}  // namespace sundog
