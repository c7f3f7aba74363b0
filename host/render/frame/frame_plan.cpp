// Plans a frame: checks AOVs, sampling and shares; creates its film, passes, tiles and workers.
#include "render/frame/frame.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "base/error.h"
#include "render/film/group_names.h"
#include "render/film/hash.h"
#include "render/film/part.h"
#include "render/film/rows.h"
#include "render/plan/tiles.h"
#include "scene/integrators.h"

namespace sundog {
namespace {

/// The variance is known only if samples are doubled in passes.
void check_variance(const std::vector<std::string>& names, const Sampling& sampling) {
  if (std::ranges::count(names, "variance") > 0 && !in_passes(sampling))
    throw UsageError(
        "the AOV 'variance' wants a frame in passes: make it adaptive, or set /render/progressive to true");
}

/// Only the path tracer knows which lobes the light has passed.
void check_light(const std::vector<std::string>& names, const CompiledScene& scene) {
  for (const std::string& name : names)
    if (is_light(name) && !integrator_of(scene.integrator).light_parts)
      throw UsageError(fmt::format("the AOV '{}' wants the integrator path: set /render/integrator",
                                   name.substr(0, name.rfind('@'))));
  if (scene.features.caustics && std::ranges::any_of(names, is_light_group))
    throw UsageError("photons do not know their groups of lights: leave caustics out, or the AOVs of groups");
}

void check_shares(const Split& split, const std::vector<WorkerPlan>& devices) {
  if (split.shares.empty() || split.shares.size() == devices.size()) return;
  std::vector<std::string> labels;
  for (const WorkerPlan& device : devices) labels.push_back(device.info.label());
  throw UsageError(fmt::format("the fixed split {}: {} share{} for {} device{} ({}): give one share a device",
                               fmt::join(split.shares, ","), split.shares.size(),
                               split.shares.size() == 1 ? "" : "s", devices.size(),
                               devices.size() == 1 ? "" : "s", fmt::join(labels, "; ")));
}

/// The key of the frame's checkpoint, a hash of scene and region; 0 without a checkpoint.
std::uint64_t frame_key(const CompiledScene& scene, const RenderOptions& options) {
  if (checkpoint_path(options).empty()) return 0;
  const std::uint64_t key = hash_scene(scene);
  return options.region ? hash_bytes(&*options.region, sizeof *options.region, key) : key;
}

Tile area_of(const CompiledScene& scene, const RenderOptions& options) {
  return frame_area(options.region, static_cast<int>(scene.info.width), static_cast<int>(scene.info.height));
}

Sampling sampling_of(const CompiledScene& scene, const RenderOptions& options) {
  Sampling sampling = scene.sampling;
  sampling.progressive |= options.passes && !in_passes(sampling);
  return sampling;
}

SamplingPlan plan_of(const CompiledScene& scene, const RenderOptions& options) {
  SamplingPlan plan = plan_sampling(scene);
  plan.settings.progressive = sampling_of(scene, options).progressive;
  plan.noise = options.noise;
  plan.surfaces = show_surfaces(options.aovs);
  plan.sums = aov_layout(options.aovs).sums() > 0;
  return plan;
}

FilmNeeds needs_of(const CompiledScene& scene, const RenderOptions& options) {
  FilmNeeds needs = film_needs(options.aovs);
  needs.shows_surfaces |= needs_surfaces(scene.sampling);
  needs.grows = in_passes(sampling_of(scene, options));
  needs.keeps_earlier =
      needs.grows && (options.noise > 0 || std::ranges::count(options.aovs, "variance") > 0 ||
                      !checkpoint_path(options).empty());
  return needs;
}

double tile_seconds_of(const DeviceInfo& device, const RenderOptions& options) {
  if (options.tile_seconds > 0) return options.tile_seconds;
  return options.tuning ? 1e-3 * options.tuning(device).tile_ms : 0;
}

std::vector<DeviceSpeed> speeds_of(const std::vector<WorkerPlan>& devices, const RenderOptions& options) {
  std::vector<DeviceSpeed> speeds;
  for (const WorkerPlan& device : devices)
    speeds.push_back({.measured = device.pixels_a_second,
                      .sample = device.measured_pixels,
                      .estimate = device.info.estimate,
                      .processor = device.processor,
                      .tile_seconds = tile_seconds_of(device.info, options)});
  return speeds;
}

/// The rows of each list of tiles: all rows, or each device's rows in a fixed split.
std::vector<RowRange> row_ranges(const Split& split, int height, std::span<const double> estimates) {
  if (split.kind == Split::Kind::dynamic) return {{0, height}};
  if (!split.shares.empty()) return divide_rows(height, split.shares);
  return divide_rows(height, estimates);
}

/// The unfinished tiles of a part of the frame that lie within `range`.
std::vector<Tile> unfinished_rows(const Film& film, const RowRange& range, const PartOfFrame& part) {
  std::vector<Tile> tiles;
  for (const RowRange& rows : part_rows(film.height, part)) {
    const int first = std::max(rows.first, range.first);
    const int end = std::min(rows.first + rows.count, range.first + range.count);
    for (const Tile& tile : unfinished_tiles(film, {0, first, film.width, std::max(0, end - first)}))
      tiles.push_back(tile);
  }
  return tiles;
}

/// The unfinished tiles of `film`. A fixed split without shares is divided by the devices' speed `estimates`.
TilePlan plan_tiles(const RenderOptions& options, const Film& film, std::span<const double> estimates) {
  TilePlan plan;
  plan.whole = options.tile > 0;
  plan.exact = !options.split.shares.empty();
  for (const RowRange& range : row_ranges(options.split, film.height, estimates)) {
    std::vector<Tile> tiles;
    for (const Tile& open : unfinished_rows(film, range, options.part)) {
      if (!plan.whole) {
        tiles.push_back(open);
        continue;
      }
      for (Tile tile : cut_tiles(open.width, open.height, options.tile)) {
        tile.x += open.x;
        tile.y += open.y;
        tiles.push_back(tile);
      }
    }
    plan.lists.emplace_back(std::move(tiles));
  }
  return plan;
}

}  // namespace

Frame::Frame(RenderOptions options_, SamplingPlan plan_, Film film_, const std::vector<DeviceSpeed>& speeds)
    : options(std::move(options_)),
      plan(std::move(plan_)),
      film(std::move(film_)),
      queue({.lists = std::vector<WaitingTiles>(1)}, speeds) {
  std::vector<double> estimates;
  for (const DeviceSpeed& speed : speeds) estimates.push_back(speed.estimate);
  tiles = [this, estimates](const Film& of_pass) { return plan_tiles(options, of_pass, estimates); };
  queue.expect_more();
}

void check_frame(const CompiledScene& scene, const std::vector<WorkerPlan>& devices,
                 const RenderOptions& options) {
  for (const std::string& name : options.aovs) check_aov(name);
  check_variance(options.aovs, scene.sampling);
  check_light(options.aovs, scene);
  if (devices.empty()) throw DeviceError("no device to render on");
  check_shares(options.split, devices);
  check_region(options.region, static_cast<int>(scene.info.width), static_cast<int>(scene.info.height));
  const auto whole = [&](const char* what) {
    return fmt::format("{} cannot be rendered in parts: leave out the part {}/{}", what, options.part.index,
                       options.part.count);
  };
  if (in_passes(scene.sampling) && options.part.count > 1)
    throw UsageError(whole("a frame that is adaptive, subsampled or progressive"));
  if (options.region && options.part.count > 1) throw UsageError(whole("a region"));
}

std::shared_ptr<Frame> plan_frame(const CompiledScene& scene, const std::vector<WorkerPlan>& devices,
                                  const RenderOptions& options) {
  const Tile area = area_of(scene, options);
  auto frame = std::make_shared<Frame>(options, plan_of(scene, options),
                                       Film(area.width, area.height, needs_of(scene, options)),
                                       speeds_of(devices, options));
  for (const WorkerPlan& device : devices)
    frame->workers.emplace_back(device.make(frame->options)).report.info = device.info;
  frame->area = area;
  frame->inner = options.region.value_or(area);
  frame->inner.x -= area.x, frame->inner.y -= area.y;
  frame->key = frame_key(scene, options);
  return frame;
}

}  // namespace sundog
