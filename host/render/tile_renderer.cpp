#include "render/tile_renderer.h"

#include <algorithm>

#include "base/clock.h"
#include "render/tiles.h"

namespace sundog {
namespace {

// A launch is short enough for a watchdog and for Ctrl-C, and long against its overhead of some microseconds.
constexpr double launch_seconds = 0.05;
constexpr std::size_t first_launch_size = 4096;  // pixel-samples, before anything is known of the device

unsigned divide_up(unsigned a, unsigned b) { return (a + b - 1) / b; }

}  // namespace

TileRenderer::TileRenderer(Device& device, const CompiledScene& scene, const RenderOptions& options,
                           RenderTimes& times)
    : device_(device),
      scene_(scene),
      options_(options),
      config_(make_kernel_config(scene, device.info())),
      next_size_(first_launch_size) {
  const Stopwatch building;
  BuildReport report;
  render_ =
      scene_kernel<Buffer<u32>, Buffer<float4>, Buffer<float>, Buffer<u32>, u32, u32, u32, u32, u32, u32, u32,
                   u32>(device.build("entry/render_whitted.cl", config_.defines, &report), "render_whitted");
  times.cached = report.cached;
  if (!options.aovs.empty()) {
    first_surfaces_ = scene_kernel<Buffer<u32>, Buffer<float4>, u32, u32, u32, u32>(
        device.build("entry/aov.cl", config_.defines, &report), "first_surfaces");
    times.cached = times.cached && report.cached;
  }
  times.build_kernels = building.seconds();
  const Stopwatch uploading;
  tables_ = upload_scene(device, scene);
  times.upload = uploading.seconds();
  if (scene.features.camera_inside) find_camera_media();
}

void TileRenderer::find_camera_media() {
  auto kernel =
      scene_kernel<Buffer<u32>>(device_.build("entry/camera_media.cl", config_.defines), "find_camera_media");
  run_scene_kernel<Buffer<u32>>(device_, kernel, {1, 1, 1, 1}, tables_, tables_.camera_media);
  device_.finish();
}

LaunchSize TileRenderer::launch_size(std::size_t items) const {
  switch (options_.work_group.kind) {
    case WorkGroup::Kind::driver:
      return {items, 1, 0, 0};
    case WorkGroup::Kind::fixed:
      return {items, 1, options_.work_group.x * options_.work_group.y, 1};
    case WorkGroup::Kind::automatic:
      break;
  }
  // With many pixels a work-item, small groups leave no unit idle at a launch's end; one ray a lane wants a
  // full group.
  const std::size_t wanted = device_.info().device_class == DeviceClass::cpu ? 16 : 64;
  return {items, 1, std::min(wanted, std::max<std::size_t>(1, device_.info().max_work_group)), 1};
}

// Cuts the tile into bands of rows, and long rows of samples into several launches, by what the last launch
// took. Samples are added one by one in the kernel, so where they are cut does not change a bit.
void TileRenderer::launch_samples(const Tile& tile, const std::atomic<bool>* stop, bool& complete) {
  const unsigned width = static_cast<unsigned>(tile.width), height = static_cast<unsigned>(tile.height);
  const unsigned samples = scene_.info.samples;
  const unsigned columns = divide_up(width, config_.tile_w);
  for (unsigned row = 0; row < height;) {
    unsigned rows =
        static_cast<unsigned>(std::min<std::size_t>(next_size_ / (width * config_.tile_h), height)) *
        config_.tile_h;
    rows = std::min(std::max(rows, config_.tile_h), height - row);
    for (unsigned sample = 0; sample < samples;) {
      if (stop && stop->load()) {
        complete = false;
        return;
      }
      const std::size_t pixels = static_cast<std::size_t>(width) * rows;
      const unsigned count =
          static_cast<unsigned>(std::clamp<std::size_t>(next_size_ / pixels, 1, samples - sample));
      const unsigned items = columns * divide_up(rows, config_.tile_h);
      const Stopwatch clock;
      run_scene_kernel<Buffer<u32>, Buffer<float4>, Buffer<float>, Buffer<u32>, u32, u32, u32, u32, u32, u32,
                       u32, u32>(device_, render_, launch_size(items), tables_, tables_.camera_media, film_,
                                 weights_, counters_, static_cast<u32>(tile.x),
                                 static_cast<u32>(tile.y) + row, width, rows, items, row * width, sample,
                                 count);
      device_.finish();
      next_size_ = next_launch_size(pixels * count, clock.seconds(), launch_seconds, width * config_.tile_h,
                                    std::size_t{1} << 30);
      sample += count;
    }
    row += rows;
  }
}

TileResult TileRenderer::render(const Tile& tile) {
  const std::size_t pixels = static_cast<std::size_t>(tile.width) * static_cast<std::size_t>(tile.height);
  TileResult result;
  result.sums.resize(pixels);
  result.weights.resize(pixels);
  std::array<u32, COUNTERS> counts{};
  if (film_.count < pixels) {
    film_ = device_.make<float4>(pixels);
    weights_ = device_.make<float>(pixels);
    if (!options_.aovs.empty()) aovs_ = device_.make<float4>(3 * pixels);
  }
  device_.write(film_, std::span<const float4>(result.sums));
  device_.write(weights_, std::span<const float>(result.weights));
  counters_ = device_.upload(std::span<const u32>(counts));
  launch_samples(tile, options_.stop, result.complete);
  if (!result.complete) return result;
  if (!options_.aovs.empty()) {
    result.aovs.resize(3 * pixels);
    run_scene_kernel<Buffer<u32>, Buffer<float4>, u32, u32, u32, u32>(
        device_, first_surfaces_, launch_size(pixels), tables_, tables_.camera_media, aovs_,
        static_cast<u32>(tile.x), static_cast<u32>(tile.y), static_cast<u32>(tile.width),
        static_cast<u32>(pixels));
    device_.finish();
    device_.read(aovs_, std::span<float4>(result.aovs));
  }
  const Stopwatch reading;
  device_.read(film_, std::span<float4>(result.sums));
  device_.read(weights_, std::span<float>(result.weights));
  device_.read(counters_, std::span<u32>(counts));
  readback_seconds_ += reading.seconds();
  std::copy(counts.begin(), counts.end(), result.counts.begin());
  return result;
}

}  // namespace sundog
