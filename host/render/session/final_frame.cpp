#include "render/session/final_frame.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "base/error.h"
#include "base/file.h"
#include "render/film/checkpoint_file.h"
#include "render/film/group_names.h"
#include "render/film/hash.h"
#include "render/plan/frame_tiles.h"

namespace sundog {
namespace {

using Scene = std::shared_ptr<const CompiledScene>;

void check_aovs(const std::vector<std::string>& names) {
  for (const std::string& name : names)
    if (!is_light_group(name) && std::ranges::count(aov_names(), name) == 0)
      throw UsageError(
          fmt::format("no AOV is called '{}'; there are {}", name, fmt::join(aov_names(), ", ")));
}

/// A variance is known where samples were doubled.
void check_variance(const std::vector<std::string>& names, const Sampling& sampling) {
  if (std::ranges::count(names, "variance") > 0 && !in_passes(sampling))
    throw UsageError(
        "the AOV 'variance' wants a frame in passes: make it adaptive, or set /render/progressive to true");
}

/// Only the path tracer knows which lobes light has come by.
void check_light(const std::vector<std::string>& names, const CompiledScene& scene) {
  for (const std::string& name : names)
    if (is_light(name) && scene.integrator != "path")
      throw UsageError(fmt::format("the AOV '{}' wants the integrator path: set /render/integrator",
                                   name.substr(0, name.rfind('@'))));
  if (scene.features.caustics && std::ranges::any_of(names, is_light_group))
    throw UsageError("photons do not know their groups of lights: leave caustics out, or the AOVs of groups");
}

/// Of a checkpoint: the scene and the region.
std::uint64_t frame_key(const CompiledScene& scene, const RenderOptions& options) {
  const std::uint64_t key = hash_scene(scene);
  return options.region ? hash_bytes(&*options.region, sizeof *options.region, key) : key;
}

void check_shares(const Split& split, const std::vector<ServerPlan>& devices) {
  if (split.shares.empty() || split.shares.size() == devices.size()) return;
  std::vector<std::string> labels;
  for (const ServerPlan& device : devices) labels.push_back(device.info.label());
  throw UsageError(fmt::format("the fixed split {}: {} share{} for {} device{} ({}): give one share a device",
                               fmt::join(split.shares, ","), split.shares.size(),
                               split.shares.size() == 1 ? "" : "s", devices.size(),
                               devices.size() == 1 ? "" : "s", fmt::join(labels, "; ")));
}

std::vector<double> estimates(const std::vector<ServerPlan>& devices) {
  std::vector<double> result;
  for (const ServerPlan& device : devices) result.push_back(device.info.estimate);
  return result;
}

Tile area_of(const CompiledScene& scene, const RenderOptions& options) {
  return frame_area(options.region, static_cast<int>(scene.info.width), static_cast<int>(scene.info.height));
}

/// The passes of a frame that has some, with what a checkpoint has of them; the frame's film is the pass's.
FramePasses begin_passes(const Scene& scene, const std::vector<ServerPlan>& devices,
                         const RenderOptions& options, std::uint64_t key, Film& film) {
  FramePasses passes;
  const auto [x, y, width, height] = area_of(*scene, options);
  passes.plan = {scene->sampling,
                 scene->info.samples,
                 options.noise,
                 show_surfaces(options.aovs),
                 aov_layout(options.aovs).sums() > 0,
                 clear_materials(*scene)};
  const bool with_earlier = options.noise > 0 || std::ranges::count(options.aovs, "variance") > 0 ||
                            !checkpoint_path(options).empty();
  passes.film = GrowingFilm(width, height, show_surfaces(options.aovs) || needs_surfaces(scene->sampling),
                            aov_layout(options.aovs), with_earlier);
  if (counts_rays(options.aovs)) passes.film.film.rays.resize(passes.film.taken.size());
  passes.tiles = [options, shares = estimates(devices)](const Film& of_pass) {
    return plan_tiles(options, of_pass, shares);
  };
  if (!options.resume.empty() && is_there(options.resume)) {
    read_growing_checkpoint(options.resume, passes.film, passes.pass, film, key);
    if (!may_be_of(passes.plan, passes.pass)) throw damaged_checkpoint(options.resume);
    return passes;
  }
  passes.pass = *next_pass(passes.film, passes.plan);
  film = film_of_pass(passes.film, passes.pass, passes.pass.surfaces);
  return passes;
}

/// A film that holds what a checkpoint has of the frame.
Film begin_film(const CompiledScene& scene, const RenderOptions& options, std::uint64_t key) {
  const Tile area = area_of(scene, options);
  Film film = Film::with_aovs(area.width, area.height, options.aovs);
  if (!options.resume.empty() && is_there(options.resume)) read_checkpoint(options.resume, film, key);
  return film;
}

std::shared_ptr<Frame> begin_frame(const Scene& scene, const std::vector<ServerPlan>& devices,
                                   const RenderOptions& options, std::uint64_t key) {
  const bool has_passes = in_passes(scene->sampling);
  if (has_passes && options.part.count > 1)
    throw UsageError("a frame that is adaptive, subsampled or progressive is made whole: leave the part out");
  Film film;
  std::optional<FramePasses> passes;
  if (has_passes)
    passes = begin_passes(scene, devices, options, key, film);
  else
    film = begin_film(*scene, options, key);
  std::vector<DeviceSpeed> speeds(devices.size());
  TilePlan plan = plan_tiles(options, film, estimates(devices));
  const auto done = static_cast<std::uint64_t>(
      std::count_if(film.done.begin(), film.done.end(), [](auto d) { return d != 0; }));
  for (std::size_t i = 0; i < devices.size(); ++i) {
    speeds[i].estimate = devices[i].info.estimate;
    speeds[i].processor = devices[i].processor;
    speeds[i].measured = devices[i].pixels_a_second;
    speeds[i].sample = devices[i].measured_pixels;
    if (options.tuning) speeds[i].tile_seconds = 1e-3 * options.tuning(devices[i].info).tile_ms;
  }
  auto frame = std::make_shared<Frame>(options, std::move(film), std::move(plan), std::move(speeds));
  for (const ServerPlan& device : devices) {
    Frame::Server server;
    server.server = device.make(frame->options);
    server.report.info = device.info;
    frame->servers.push_back(std::move(server));
  }
  frame->area = area_of(*scene, options);
  frame->inner = options.region.value_or(frame->area);
  frame->inner.x -= frame->area.x, frame->inner.y -= frame->area.y;
  frame->pixels_done = frame->pixels_kept = done;
  frame->key = key;
  if (passes) {
    frame->passes = std::move(passes);
    frame->queue.expect_more();
    plan_next_pass(*frame);
  }
  return frame;
}

/// The same without a checkpoint that does not fit, if the options want that; `left` says why it does not.
std::shared_ptr<Frame> begin_or_renew(const Scene& scene, const std::vector<ServerPlan>& devices,
                                      const RenderOptions& options, std::uint64_t key, std::string& left) {
  try {
    return begin_frame(scene, devices, options, key);
  } catch (const std::exception& error) {
    if (!options.renews_checkpoint || !is_there(options.resume)) throw;
    left = error.what();
  }
  RenderOptions anew = options;
  anew.checkpoint = checkpoint_path(options);
  anew.resume.clear();
  return begin_frame(scene, devices, anew, key);
}

std::vector<DeviceReport> reports(Frame& frame) {
  std::vector<DeviceReport> result;
  double pixels = static_cast<double>(std::max<std::size_t>(1, frame.film.done.size()));
  if (frame.passes) {
    pixels = 1;
    for (const Frame::Server& server : frame.servers) pixels += static_cast<double>(server.report.pixels);
  }
  for (std::size_t i = 0; i < frame.servers.size(); ++i) {
    DeviceReport report = frame.servers[i].report;
    report.busy_seconds = frame.queue.work(i).busy_seconds;
    report.share = static_cast<double>(report.pixels) / pixels;
    result.push_back(std::move(report));
  }
  return result;
}

double frame_efficiency(const Frame& frame) {
  std::vector<DeviceWork> work;
  for (std::size_t i = 0; i < frame.servers.size(); ++i) work.push_back(frame.queue.work(i));
  return efficiency(work);
}

/// Keeps what an interrupted frame has; a disk that is full must not take the image along.
void keep_checkpoint(const Frame& frame, RenderResult& result) {
  if (checkpoint_path(frame.options).empty() || result.complete) return;
  try {
    write_frame_checkpoint(frame, checkpoint_path(frame.options));
    result.checkpoint_kept = true;
  } catch (const IoError& error) {
    result.checkpoint_error = error.what();
  }
}

/// Of a frame in passes. One that its time limit has ended shows its whole passes: with what there is of
/// another, parts of the picture would have twice the samples of others.
GrowingFilm shown_film(Frame& frame, const RenderResult& result) {
  if (result.time_limited && frame.passes->film.stage > 0) frame.film = Film();
  return result.complete ? std::move(frame.passes->film) : film_so_far(frame);
}

/// Leaves the region alone of what the frame has made.
void cut_to_region(const Frame& frame, RenderResult& result) {
  if (!frame.options.region) return;
  const int width = result.film.width;
  result.film = result.film.cut(frame.inner);
  result.taken = cut_pixels(result.taken, width, frame.inner);
  for (auto& [name, image] : result.aovs) {
    image.data = cut_pixels(image.data, width, frame.inner, static_cast<std::size_t>(image.channels));
    image.width = frame.inner.width, image.height = frame.inner.height;
  }
}

/// Gathers the film, complete or not.
RenderResult finish_frame(Frame& frame, std::uint64_t key) {
  const std::lock_guard lock(frame.mutex);
  RenderResult result;
  result.devices = reports(frame);
  result.key = key;
  result.complete = frame.queue.complete();
  result.time_limited = frame.limited && !result.complete;
  keep_checkpoint(frame, result);
  if (frame.passes) {
    GrowingFilm film = shown_film(frame, result);
    if (std::ranges::count(frame.options.aovs, "variance") > 0)
      result.aovs["variance"] = develop_variance(film);
    result.film = std::move(film.film);
    result.taken = std::move(film.taken);
    result.surfaces_seen = film.surfaces_seen;
    result.passes = film.stage;
  } else {
    result.film = std::move(frame.film);
  }
  cut_to_region(frame, result);
  result.efficiency = frame_efficiency(frame);
  result.counts = frame.counts;
  if (frame.options.channels > 0) {
    result.image = result.film.develop(frame.options.channels);
    for (const std::string& name : frame.options.aovs)
      if (name == "samples")
        result.aovs[name] = develop_samples(result.film, result.taken);
      else if (name != "variance")
        result.aovs[name] = result.film.develop_aov(name);
  }
  result.times = frame.times;
  if (frame.timed)
    result.times.build_kernels += first_launch_seconds(frame.servers[*frame.timed].report.kernels);
  result.times.readback = frame.readback;
  result.times.render = std::max(
      0.0, frame.clock.seconds() - result.times.build_kernels - result.times.upload - frame.readback);
  return result;
}

}  // namespace

RenderResult render_frame(const Scene& scene, const std::vector<ServerPlan>& devices,
                          const RenderOptions& options,
                          const std::function<void(const std::shared_ptr<Frame>&)>& run) {
  check_aovs(options.aovs);
  check_variance(options.aovs, scene->sampling);
  check_light(options.aovs, *scene);
  if (devices.empty()) throw DeviceError("no device to render on");
  check_shares(options.split, devices);
  check_region(options.region, static_cast<int>(scene->info.width), static_cast<int>(scene->info.height));
  if (options.region && options.part.count > 1)
    throw UsageError("a region is made whole: leave the part out");
  const std::uint64_t key = checkpoint_path(options).empty() ? 0 : frame_key(*scene, options);
  std::string left;
  const std::shared_ptr<Frame> frame = begin_or_renew(scene, devices, options, key, left);
  run(frame);
  const bool stopped = options.stop && options.stop->load();
  RenderResult result = finish_frame(*frame, key);
  result.checkpoint_left = std::move(left);
  if (!result.complete && !stopped) result.failure = frame->last_error;
  if (result.failure && !(options.keep_failed && frame->pixels_done > 0))
    std::rethrow_exception(result.failure);
  return result;
}

}  // namespace sundog
