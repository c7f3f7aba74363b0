#include "render/tile_renderer.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/clock.h"
#include "base/error.h"
#include "base/faults.h"
#include "device/cl_status.h"
#include "render/tiles.h"

namespace sundog {
namespace {

// A launch is short enough for a watchdog and for Ctrl-C, and long against its overhead of some microseconds.
constexpr double launch_seconds = 0.05;
// Pixel-samples before anything is known of the device; a field's may take a thousand times as long.
constexpr std::size_t first_launch_size = 4096, first_launch_size_of_fields = 512;

// Resources that ran out may be those of a group, where it has more work-items than this.
constexpr std::size_t small_group = 64;

void check_work_group(const DeviceInfo& device, std::size_t most, const WorkGroup& group) {
  if (group.kind == WorkGroup::Kind::fixed && most > 0 && group.x * group.y > most)
    throw UsageError(
        fmt::format("{}: a work-group of {} is more than the {} that it can have in this scene; ask for "
                    "less, or for a smaller max_depth",
                    device.label(), group.x * group.y, most));
}

/// Halves the longer side of a group until it has at most `most` work-items (0: any number).
LaunchSize within(LaunchSize size, std::size_t most) {
  while (most > 0 && size.local_x * size.local_y > most) {
    std::size_t& side = size.local_x >= size.local_y ? size.local_x : size.local_y;
    side /= 2;
  }
  return size;
}

unsigned divide_up(unsigned a, unsigned b) { return (a + b - 1) / b; }

/// The driver ended a kernel's loops before their end: smaller launches may be within its limit.
struct LoopsCutShort : DeviceError {
  using DeviceError::DeviceError;
};

}  // namespace

TileRenderer::TileRenderer(Device& device, const CompiledScene& scene, const RenderOptions& options,
                           RenderTimes& times, LaunchWatch& watch)
    : device_(device),
      scene_(scene),
      options_(options),
      tuning_(options.tuning ? options.tuning(device.info()) : Tuning{}),
      config_(make_kernel_config(scene, device.info(), tuning_)),
      watch_(watch),
      next_size_(scene.sdf_fields.empty() ? first_launch_size : first_launch_size_of_fields) {
  most_group_ = greatest_work_group(config_, device.info());
  check_work_group(device.info(), most_group_, options.work_group);
  const Stopwatch building;
  times.cached = true;
  render_ = scene_kernel<Buffer<u32>, Buffer<float4>, Buffer<float>, Buffer<u32>, u32, u32, u32, u32, u32,
                         u32, u32, u32, u32>(build("entry/render_whitted.cl", times), "render_whitted");
  if (!options.aovs.empty())
    first_surfaces_ = scene_kernel<Buffer<u32>, Buffer<float4>, Buffer<u32>, u32, u32, u32, u32>(
        build("entry/aov.cl", times), "first_surfaces");
  limit_groups();
  times.build_kernels = building.seconds();
  const Stopwatch uploading;
  tables_ = upload_scene(device, scene);
  times.upload = uploading.seconds();
  if (scene.features.camera_inside) find_camera_media();
}

// The kernels' own limits are known once they are built: theirs are what a group's registers suffice for.
void TileRenderer::limit_groups() {
  const auto limit = [&](std::size_t kernels) {
    if (kernels > 0) most_group_ = most_group_ > 0 ? std::min(most_group_, kernels) : kernels;
  };
  limit(device_.limits(render_).work_group);
  if (!options_.aovs.empty()) limit(device_.limits(first_surfaces_).work_group);
  check_work_group(device_.info(), most_group_, options_.work_group);
  // What was fastest for a scene of less depth may be too large for this one.
  if (most_group_ > 0 && tuning_.work_group.x * tuning_.work_group.y > most_group_) tuning_.work_group = {};
  if (most_group_ > 0 && tuning_.surfaces_group.x > most_group_) tuning_.surfaces_group = {};
}

Program TileRenderer::build(const char* entry, RenderTimes& times) {
  BuildReport report;
  Program program = device_.build(entry, config_.defines, &report, config_.generated);
  times.cached = times.cached && report.cached;
  if (!report.note.empty()) notes_.push_back("no kernel cache: " + report.note);
  return program;
}

void TileRenderer::find_camera_media() {
  auto kernel = scene_kernel<Buffer<u32>>(
      device_.build("entry/camera_media.cl", config_.defines, nullptr, config_.generated),
      "find_camera_media");
  run_scene_kernel<Buffer<u32>>(device_, kernel, {1, 1, 1, 1}, tables_, tables_.camera_media);
  device_.finish();
}

// The user's, else the tuned one, else the default.
const WorkGroup& TileRenderer::work_group() const {
  return options_.work_group.kind == WorkGroup::Kind::automatic ? tuning_.work_group : options_.work_group;
}

// columns x rows work-items: as a grid where the user asked for a group of two dimensions, else in one row.
LaunchSize TileRenderer::launch_size(std::size_t columns, std::size_t rows) const {
  const WorkGroup& group = work_group();
  const std::size_t items = columns * rows;
  if (group.kind == WorkGroup::Kind::driver) return {items, 1, 0, 0};
  if (group.kind == WorkGroup::Kind::fixed) {
    return within(
        group.y > 1 ? LaunchSize{columns, rows, group.x, group.y} : LaunchSize{items, 1, group.x, 1},
        most_group_);
  }
  if (alone_) return {items, 1, 1, 1};
  // One ray a lane wants a full group, if only to fill the driver's vectors. With many pixels a work-item,
  // small groups leave no unit idle at a launch's end, as PoCL hands them out 32 at a time; of two sizes, as
  // it compiles for each.
  const std::size_t share = items / (4 * std::max(1u, device_.info().compute_units));
  std::size_t wanted = 64;
  if (device_.info().device_class == DeviceClass::cpu) {
    const bool many_pixels = config_.tile_w * config_.tile_h > 1;
    wanted = many_pixels ? (share < 4 ? 1 : 4) : std::clamp<std::size_t>(share, 8, 64);
  }
  return within({items, 1, wanted, 1}, most_group_);
}

// Cuts the tile into runs of work-items, and long rows of samples into several launches, by what the last
// launch took. Samples are added one by one in the kernel, so where they are cut does not change a bit.
// Returns the rows that have all their samples.
unsigned TileRenderer::launch_samples(const Tile& tile, const StopFlags& flags) {
  const unsigned width = static_cast<unsigned>(tile.width), height = static_cast<unsigned>(tile.height);
  const unsigned samples = scene_.info.samples, item_pixels = config_.tile_w * config_.tile_h;
  const bool grid = work_group().kind == WorkGroup::Kind::fixed && work_group().y > 1;
  // Rows of items: of tiles, or of blocks of 8x4 pixels (lane_pixel() in render_whitted.cl).
  const bool blocks = item_pixels == 1 && !grid;
  const unsigned row_height = blocks ? 4 : config_.tile_h;
  const unsigned columns = blocks ? divide_up(width, 8) * 32 : divide_up(width, config_.tile_w);
  const unsigned rows = divide_up(height, row_height);
  // A grid of groups takes whole rows of items; else each unit should have one.
  const unsigned step = grid ? columns : std::clamp(device_.info().compute_units, 1u, columns * rows);
  least_size_ = static_cast<std::size_t>(step) * item_pixels;
  for (unsigned item = 0; item < columns * rows;) {
    const std::size_t wanted = next_size_ / least_size_ * step;
    const unsigned items =
        static_cast<unsigned>(std::clamp<std::size_t>(wanted, step, columns * rows - item));
    const std::size_t pixels = static_cast<std::size_t>(items) * item_pixels;
    for (unsigned sample = 0; sample < samples;) {
      if (flags.set()) return std::min(item / columns * row_height, height);
      const unsigned left = std::min(samples - sample, most_samples_);
      const unsigned count = static_cast<unsigned>(std::clamp<std::size_t>(next_size_ / pixels, 1, left));
      last_samples_ = std::max(last_samples_, count);
      const LaunchSize size = grid ? launch_size(columns, items / columns) : launch_size(items, 1);
      last_size_ = pixels * count;
      last_group_ = size.local_x * size.local_y;
      const Stopwatch clock;
      const WatchedLaunch watched(watch_, pixel_seconds_ * static_cast<double>(last_size_),
                                  pixel_seconds_ <= 0);
      run_scene_kernel<Buffer<u32>, Buffer<float4>, Buffer<float>, Buffer<u32>, u32, u32, u32, u32, u32, u32,
                       u32, u32, u32>(device_, render_, size, tables_, tables_.camera_media, film_, weights_,
                                      counters_, static_cast<u32>(tile.x), static_cast<u32>(tile.y), width,
                                      height, static_cast<u32>(size.x), item, item + items, sample, count);
      device_.finish();
      note_time(last_size_, clock.seconds());
      sample += count;
    }
    item += items;
  }
  return height;
}

void TileRenderer::note_time(std::size_t size, double seconds) {
  const double target = tuning_.launch_ms > 0 ? tuning_.launch_ms * 1e-3 : launch_seconds;
  next_size_ = next_launch_size(size, seconds, target, least_size_, most_size_);
  pixel_seconds_ = seconds / static_cast<double>(size);
}

void TileRenderer::launch_aovs(const Tile& tile, std::vector<float4>& aovs) {
  const std::size_t pixels = static_cast<std::size_t>(tile.width) * static_cast<std::size_t>(tile.height);
  if (aovs_.count < 3 * pixels) aovs_ = device_.make<float4>(3 * pixels);
  aovs.resize(3 * pixels);
  if (pixels == 0) return;
  const bool tuned = tuning_.surfaces_group.kind == WorkGroup::Kind::fixed;
  const LaunchSize size = within({divide_up(static_cast<unsigned>(pixels), config_.tile_w * config_.tile_h),
                                  1, tuned ? tuning_.surfaces_group.x : 16, 1},
                                 most_group_);
  last_group_ = size.local_x;
  constexpr double expected = 3;  // not known: only what stands for minutes is stuck
  const WatchedLaunch watched(watch_, expected, !aovs_launched_);
  run_scene_kernel<Buffer<u32>, Buffer<float4>, Buffer<u32>, u32, u32, u32, u32>(
      device_, first_surfaces_, size, tables_, tables_.camera_media, aovs_, counters_,
      static_cast<u32>(tile.x), static_cast<u32>(tile.y), static_cast<u32>(tile.width),
      static_cast<u32>(pixels));
  device_.finish();
  aovs_launched_ = true;
  device_.read(aovs_, std::span<float4>(aovs));
}

// Halves the launches; false when they are as small as they can be.
bool TileRenderer::shrink(const std::string& why) {
  if (last_size_ <= least_size_) return false;
  most_size_ = next_size_ = std::max(last_size_ / 2, least_size_);
  notes_.push_back(fmt::format("{}: launches of at most {} pixel-samples from here on", why, most_size_));
  return true;
}

// Halves the work-groups; false when the last one had no more than `least` work-items.
bool TileRenderer::shrink_group(const std::string& why, std::size_t least) {
  if (last_group_ <= least) return false;
  most_group_ = last_group_ / 2;
  notes_.push_back(fmt::format("{}: work-groups of at most {} from here on", why, most_group_));
  return true;
}

// Halves the samples of a launch, and at last gives each work-item a group of its own, whose loops no other
// shares; false when there is nothing less.
bool TileRenderer::ask_less(const std::string& why) {
  if (last_samples_ > 1) {
    most_samples_ = last_samples_ / 2;
    notes_.push_back(
        fmt::format("{}; launches of at most {} samples a pixel from here on", why, most_samples_));
    return true;
  }
  if (alone_ || options_.work_group.kind != WorkGroup::Kind::automatic) return false;
  alone_ = true;
  tuning_.work_group = {};
  notes_.push_back(why + "; work-groups of one from here on");
  return true;
}

// Whether every sample was traced to its end: a driver may end a kernel's loops early without an error.
void TileRenderer::check_finished(const Tile& asked, const TileResult& made) {
  const auto primary = static_cast<u32>(made.counts[COUNT_PRIMARY]);  // the device's sums are modulo 2^32
  auto finished = static_cast<u32>(made.counts[COUNT_FINISHED]);
  const auto wanted = static_cast<u32>(pixel_count(made.tile) * scene_.info.samples);
  const auto aovs = options_.aovs.empty() ? 0u : static_cast<u32>(pixel_count(made.tile));
  if (fault("cut", fmt::format("{}:{}", device_.info().platform, device_.info().device), last_samples_))
    finished = 0;
  // A tile that was stopped may have samples of rows that are not finished.
  if (finished == 2 * (primary + aovs) && (primary == wanted || made.tile != asked)) return;
  throw LoopsCutShort(
      fmt::format("{}: the driver ends the kernel's loops too early ({} of {} samples were traced to "
                  "their end)",
                  device_.info().label(), finished / 2, std::max(wanted, primary)));
}

TileResult TileRenderer::render(const Tile& tile, const StopFlags& flags) {
  while (true) {
    last_size_ = last_group_ = 0;
    last_samples_ = 0;
    try {
      TileResult made = try_render(tile, flags);
      check_finished(tile, made);
      return made;
    } catch (const LoopsCutShort& error) {
      if (ask_less(error.what())) continue;
      throw DeviceError(std::string(error.what()) +
                        "; a single sample of a pixel is too much for it: choose another device");
    } catch (const DeviceError& error) {
      if (is_work_group_too_large(error.status) && shrink_group(error.what(), 1)) continue;
      if (!is_out_of_resources(error.status)) throw;
      if (!shrink_group(error.what(), small_group) && !shrink(error.what()) && !shrink_group(error.what(), 1))
        throw;
    }
  }
}

// A failed launch may have added some of its samples, so a tile is always begun from nothing.
TileResult TileRenderer::try_render(const Tile& tile, const StopFlags& flags) {
  const std::size_t pixels = static_cast<std::size_t>(tile.width) * static_cast<std::size_t>(tile.height);
  TileResult result;
  result.tile = tile;
  result.sums.resize(pixels);
  result.weights.resize(pixels);
  std::array<u32, COUNTERS> counts{};
  if (film_.count < pixels) {
    film_ = device_.make<float4>(pixels);
    weights_ = device_.make<float>(pixels);
  }
  device_.write(film_, std::span<const float4>(result.sums));
  device_.write(weights_, std::span<const float>(result.weights));
  counters_ = device_.upload(std::span<const u32>(counts));
  result.tile.height = static_cast<int>(launch_samples(tile, flags));
  if (!options_.aovs.empty()) launch_aovs(result.tile, result.aovs);
  const Stopwatch reading;
  device_.read(film_, std::span<float4>(result.sums));
  device_.read(weights_, std::span<float>(result.weights));
  device_.read(counters_, std::span<u32>(counts));
  readback_seconds_ += reading.seconds();
  std::copy(counts.begin(), counts.end(), result.counts.begin());
  return result;
}

}  // namespace sundog
