// Renders a tile: writes its initial values, launches samples, reads the sums. After a failure it restarts
// the tile with smaller launches.
#include "render/frame/tile_renderer.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "base/clock.h"
#include "base/environment.h"
#include "base/error.h"
#include "base/faults.h"
#include "device/cl_status.h"
#include "render/plan/passes.h"
#include "render/plan/tiles.h"

namespace sundog {
namespace {

/// The driver ended a kernel's loops early; smaller launches may stay within its limit.
struct LoopsCutShort : DeviceError {
  using DeviceError::DeviceError;
};

/// Whether the request's samples find the surfaces: a pixel's first samples do.
bool looks(const TileRequest& request) { return request.surfaces && request.first_sample == 0; }

/// The counters of a tile's launches, in blocks.
using LaunchCounts = std::array<u32, std::size_t{COUNTER_BLOCKS} * COUNTER_BLOCK>;

/// After an exception, waits for transfers that may still be running.
class SettledAtEnd {
 public:
  explicit SettledAtEnd(Device& device) : device_(device), before_(std::uncaught_exceptions()) {}
  ~SettledAtEnd() {
    if (std::uncaught_exceptions() > before_) device_.settle();
  }
  SettledAtEnd(const SettledAtEnd&) = delete;
  SettledAtEnd& operator=(const SettledAtEnd&) = delete;

 private:
  Device& device_;
  int before_;
};

Tuning tuning_of(const RenderOptions& options, const DeviceInfo& device) {
  return options.tuning ? options.tuning(device) : Tuning{};
}

LaunchLimits limits_of(const DeviceInfo& device, const FrameKernels& kernels) {
  const KernelConfig& config = kernels.config;
  return {device.device_class, device.compute_units,
          config.tile_w,       config.tile_h,
          kernels.most_group,  config.tile_w * config.tile_h > 1 ? kernels.most_run : 1};
}

bool makes_aovs(const CompiledScene& scene, const RenderOptions& options) {
  return show_surfaces(options.aovs) || needs_surfaces(scene.sampling);
}

/// Applies a frame's options to the kernels.
FrameKernels wanted_by(const RenderOptions& options, KernelStore* store, FrameKernels kernels) {
  kernels.store = options.kernels == KernelChoice::own_when_built ? store : nullptr;
  kernels.choice = options.kernels;
  const AovLayout layout = aov_layout(options.aovs);
  kernels.wanted_aovs = {layout.surfaces == all_aov_vectors, shows_features(options.aovs)};
  kernels.mattes = layout.mattes;
  kernels.light = layout.light;
  kernels.groups = layout.groups;
  kernels.counts_rays = counts_rays(options.aovs);
  kernels.notes.clear();
  return kernels;
}

/// How to respond to a failed launch; nothing if smaller launches would not help.
std::optional<LaunchFailure> failure_of(const DeviceError& error) {
  if (dynamic_cast<const LoopsCutShort*>(&error)) return LaunchFailure::loops_cut_short;
  if (is_work_group_too_large(error.status)) return LaunchFailure::group_too_large;
  if (is_out_of_resources(error.status)) return LaunchFailure::out_of_resources;
  return std::nullopt;
}

}  // namespace

TileRenderer::TileRenderer(Device& device, const CompiledScene& scene, const RenderOptions& options,
                           RenderTimes& times, LaunchWatch& watch, KernelStore* store)
    : device_(device),
      store_(store),
      marches_(!scene.sdf_fields.empty()),
      tuning_(tuning_of(options, device.info())),
      asked_(options.work_group),
      kernels_(wanted_by(options, store, {})),
      update_(
          update_frame_kernels(device, scene, tuning_, asked_, makes_aovs(scene, options), kernels_, times)),
      photons_(scene),
      sizer_(limits_of(device.info(), kernels_), asked_, tuning_, marches_),
      watch_(watch),
      layout_(aov_layout(options.aovs)) {}

void TileRenderer::change_scene(const CompiledScene& scene, const RenderOptions& options,
                                RenderTimes& times) {
  const Tuning tuning = tuning_of(options, device_.info());
  const bool same_tuning = tuning == tuning_, same_group = options.work_group == asked_;
  layout_ = aov_layout(options.aovs);
  marches_ = !scene.sdf_fields.empty();
  tuning_ = tuning;
  asked_ = options.work_group;
  photons_ = PhotonMaps(scene);
  kernels_ = wanted_by(options, store_, std::move(kernels_));
  update_ =
      update_frame_kernels(device_, scene, tuning_, asked_, makes_aovs(scene, options), kernels_, times);
  const bool same_scene = update_.uploads.bytes == 0 && !update_.uploads.numbers;
  if (update_.changed || !same_tuning || !(same_group || same_scene))
    sizer_ = LaunchSizer(limits_of(device_.info(), kernels_), asked_, tuning_, marches_);
  else if (!same_group)
    sizer_.ask_for(asked_);
  else if (!same_scene)
    sizer_.calm();
}

void TileRenderer::keep_programs() { device_.save_programs(); }

void TileRenderer::rest() {
  device_.save_programs();
  if (kernels_.store)
    kernels_.store->build_general(device_, {kernels_.entry, kernels_.integrator.name, kernels_.config});
}

void TileRenderer::prepare_surfaces() {
  RenderTimes times;
  add_first_surfaces(device_, kernels_, times);
}

// Returns the number of rows that have all samples. With photons, all pixels get the samples of the current
// maps before further maps are made.
unsigned TileRenderer::launch_samples(const TileRequest& request, const StopFlags& flags) {
  u32 first = request.first_sample;
  const u32 end = first + request.sample_count;
  while (first < end && !flags.set()) {
    if (!photons_.prepare({device_, kernels_, watch_}, flags, first, end)) return 0;
    const u32 last = photons_.end_of_maps(first, end);
    sizer_.begin(request.tile, last - first);
    while (!flags.set()) {
      const std::optional<SizedLaunch> next = sizer_.next();
      if (!next) break;
      Launch launch = next->launch;
      launch.first_sample += first;
      launch.listed = !request.pixels.empty();
      launch.counts_rays = kernels_.counts_rays || request.costs;
      sizer_.note_time(launch_integrator(launch, *next));
    }
    if (last == end) return sizer_.finished_rows();
    first = last;
  }
  return 0;
}

// Returns the launch's seconds, excluding the driver's preparation of a first launch.
double TileRenderer::launch_integrator(const Launch& launch, const SizedLaunch& sized) {
  const double first_launches = first_launch_seconds(device_.times());
  const Stopwatch clock;
  const WatchedLaunch watched(watch_, sized.expected_seconds, sized.expected_seconds <= 0,
                              value_of(device_.info().environment).launch_limit);
  run_scene_kernel(device_, kernels_.integrator, sized.size, kernels_.tables, kernels_.tables.camera_media,
                   pixels_, film_, weights_, counters_, rays_, launch);
  device_.finish();
  return clock.seconds() - (first_launch_seconds(device_.times()) - first_launches);
}

// Copies `count` vectors per pixel from `from` to the pixels' AOVs, which have `vectors` each, starting at
// vector `first`.
static void put_vectors(std::span<const float4> from, std::size_t count, std::size_t first,
                        std::size_t vectors, std::vector<float4>& aovs) {
  for (std::size_t i = 0; count > 0 && i < from.size() / count; ++i)
    std::copy_n(from.begin() + static_cast<std::ptrdiff_t>(count * i), count,
                aovs.begin() + static_cast<std::ptrdiff_t>(vectors * i + first));
}

void TileRenderer::look_at_surfaces(const TileRequest& request, TileResult& result) {
  const Tile& tile = result.tile;
  const std::size_t pixels = pixel_count(tile), vectors = pixels * layout_.surfaces;
  if (aovs_.count < vectors) aovs_ = device_.make<float4>(vectors);
  if (pixels == 0) return;
  constexpr double expected = 3;  // unknown, so only minutes count as stuck
  const WatchedLaunch watched(watch_, expected, !aovs_launched_,
                              value_of(device_.info().environment).launch_limit);
  run_scene_kernel(device_, kernels_.first_surfaces, sizer_.surfaces(pixels), kernels_.tables,
                   kernels_.tables.camera_media, pixels_, aovs_, counters_, static_cast<u32>(tile.x),
                   static_cast<u32>(tile.y), static_cast<u32>(tile.width), static_cast<u32>(pixels),
                   request.pixels.empty() ? 0u : 1u);
  device_.finish();
  aovs_launched_ = true;
  std::vector<float4> surfaces(vectors);
  device_.read(aovs_, std::span<float4>(surfaces));
  put_vectors(surfaces, layout_.surfaces, 0, layout_.vectors(), result.aovs);
}

// Checks that every sample was finished, because a driver may end a kernel's loops early without an error.
void TileRenderer::check_finished(const TileRequest& asked, const TileResult& made) {
  const auto primary = static_cast<u32>(made.counts[COUNT_PRIMARY]);  // the device's sums are modulo 2^32
  auto finished = static_cast<u32>(made.counts[COUNT_FINISHED]);
  std::uint64_t pixels = pixel_count(made.tile);
  if (!asked.pixels.empty()) {
    const auto first = asked.pixels.begin();
    pixels -= static_cast<std::uint64_t>(
        std::count(first, first + static_cast<std::ptrdiff_t>(pixels), static_cast<u32>(NO_PIXEL)));
  }
  const auto wanted = static_cast<u32>(pixels * asked.sample_count);
  const auto aovs = looks(asked) ? static_cast<u32>(pixels) : 0u;
  if (fault(value_of(device_.info().environment).faults, "cut", device_.info().place(),
            sizer_.tile_samples()))
    finished = 0;
  // A stopped tile may have samples of unfinished rows.
  if (finished == 2 * (primary + aovs) && (primary == wanted || made.tile != asked.tile)) return;
  throw LoopsCutShort(fmt::format(
      "{}: the driver ends the kernel's loops too early ({} of {} samples were traced to their end)",
      device_.info().label(), finished / 2, std::max(wanted, primary)));
}

TileResult TileRenderer::render(const TileRequest& request, const StopFlags& flags) {
  if (take_wanted_kernel(device_, kernels_))
    sizer_ = LaunchSizer(limits_of(device_.info(), kernels_), asked_, tuning_, marches_);
  while (true) {
    try {
      TileResult made = try_render(request, flags);
      check_finished(request, made);
      return made;
    } catch (const DeviceError& error) {
      const std::optional<LaunchFailure> failure = failure_of(error);
      if (!failure) throw;
      const std::optional<std::string> note = sizer_.ask_less(*failure, error.what());
      if (note) {
        kernels_.notes.push_back(*note);
        continue;
      }
      if (*failure != LaunchFailure::loops_cut_short) throw;
      throw DeviceError(std::string(error.what()) +
                        "; a single sample of a pixel is too much for it: choose another device");
    }
  }
}

// Writes the initial values of the tile's samples: zero, or a pass's earlier samples.
void TileRenderer::write_start(const TileRequest& request, TileResult& result) {
  const auto pixels = static_cast<std::size_t>(pixel_count(request.tile));
  if (weights_.count < pixels) weights_ = device_.make<float>(pixels);
  const std::size_t sums = layout_.sums();  // the kernel writes these sums, requested or not
  if (film_.count < (1 + sums) * pixels) film_ = device_.make<float4>((1 + sums) * pixels);
  if (pixels_.count < std::max<std::size_t>(1, request.pixels.size()))
    pixels_ = device_.make<u32>(std::max<std::size_t>(1, request.pixels.size()));
  if (!request.pixels.empty()) device_.begin_write(pixels_, std::span<const u32>(request.pixels));
  result.sums.resize(pixels);
  result.weights.resize(pixels);
  const std::size_t counted = kernels_.counts_rays || request.costs ? pixels : 0;
  if (rays_.count < pixels) rays_ = device_.make<u32>(pixels);
  result.rays.resize(counted);
  if (request.first_sample > 0) {  // otherwise kernels start from 0
    device_.begin_write(film_, std::span<const float4>(request.sums));
    if (sums > 0 && request.surfaces) write_sums(request);
    device_.begin_write(weights_, std::span<const float>(request.weights));
    if (counted == 0) no_rays_.resize(pixels);
    device_.begin_write(rays_, std::span<const u32>(counted > 0 ? request.rays : no_rays_));
  }
  static constexpr LaunchCounts none{};
  if (counters_.count == 0) counters_ = device_.make<u32>(none.size());
  device_.begin_write(counters_, std::span<const u32>(none));
}

void TileRenderer::write_sums(const TileRequest& request) {
  const std::size_t pixels = request.sums.size(), count = layout_.sums(), vectors = layout_.vectors();
  std::vector<float4> sums(count * pixels);
  for (std::size_t i = 0; i < pixels; ++i)
    std::copy_n(request.aovs.begin() + static_cast<std::ptrdiff_t>(vectors * i + layout_.surfaces), count,
                sums.begin() + static_cast<std::ptrdiff_t>(count * i));
  device_.write(film_, std::span<const float4>(sums), pixels);
}

void TileRenderer::read_aovs(const TileRequest& request, TileResult& result) {
  const std::size_t pixels = pixel_count(result.tile), whole = pixel_count(request.tile);
  result.aovs = request.aovs;
  result.aovs.resize(layout_.vectors() * pixels);
  if (looks(request)) look_at_surfaces(request, result);
  if (layout_.sums() == 0 || request.sample_count == 0 || pixels == 0) return;
  std::vector<float4> sums(layout_.sums() * pixels);
  device_.read(film_, std::span<float4>(sums), whole);
  put_vectors(sums, layout_.sums(), layout_.surfaces, layout_.vectors(), result.aovs);
}

std::uint64_t TileRenderer::count_lost_pixels(std::size_t pixels) {
  std::vector<u32> rays(pixels);
  device_.read(rays_, std::span<u32>(rays));
  return static_cast<std::uint64_t>(
      std::ranges::count_if(rays, [](u32 count) { return (count & LOST_PIXEL) != 0; }));
}

// Waits only once, for all arrays.
void TileRenderer::read_result(unsigned samples, TileResult& result) {
  const Stopwatch reading;
  LaunchCounts counts;
  if (samples > 0) {
    device_.begin_read(film_, std::span<float4>(result.sums));
    device_.begin_read(weights_, std::span<float>(result.weights));
    if (!result.rays.empty()) device_.begin_read(rays_, std::span<u32>(result.rays));
  }
  device_.read(counters_, std::span<u32>(counts));
  for (std::size_t i = 0; i < counts.size(); ++i)
    if (i % COUNTER_BLOCK < COUNTERS) result.counts[i % COUNTER_BLOCK] += counts[i];
  if (result.counts[COUNT_STRAY_EXIT] + result.counts[COUNT_MEDIA_STACK_OVERFLOW] > 0)
    result.counts[COUNT_LOST_PIXEL] = count_lost_pixels(pixel_count(result.tile));
  for (u32& rays : result.rays) rays &= ~LOST_PIXEL;
  readback_seconds_ += reading.seconds();
}

// A failed launch may have added some samples, so every attempt starts from the tile's initial values.
TileResult TileRenderer::try_render(const TileRequest& request, const StopFlags& flags) {
  TileResult result;
  result.tile = request.tile;
  const SettledAtEnd settled(device_);
  write_start(request, result);
  if (request.sample_count > 0) result.tile.height = static_cast<int>(launch_samples(request, flags));
  if (request.surfaces) read_aovs(request, result);
  read_result(request.sample_count, result);
  return result;
}

}  // namespace sundog
