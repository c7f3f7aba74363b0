#include "render/session/final_frame.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "base/error.h"
#include "base/file.h"
#include "render/film/checkpoint.h"
#include "render/film/hash.h"
#include "render/plan/frame_tiles.h"

namespace sundog {
namespace {

using Scene = std::shared_ptr<const CompiledScene>;

void check_aovs(const std::vector<std::string>& names) {
  for (const std::string& name : names)
    if (std::find(aov_names().begin(), aov_names().end(), name) == aov_names().end())
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
      throw UsageError(fmt::format("the AOV '{}' wants the integrator path: set /render/integrator", name));
}

/// Of a checkpoint: the scene and the region.
std::uint64_t frame_key(const CompiledScene& scene, const RenderOptions& options) {
  const std::uint64_t key = hash_scene(scene);
  return options.region ? hash_bytes(&*options.region, sizeof *options.region, key) : key;
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

std::vector<double> estimates(const std::vector<WorkerPlan>& devices) {
  std::vector<double> result;
  for (const WorkerPlan& device : devices) result.push_back(device.info.estimate);
  return result;
}

Tile area_of(const CompiledScene& scene, const RenderOptions& options) {
  return frame_area(options.region, static_cast<int>(scene.info.width), static_cast<int>(scene.info.height));
}

SamplingPlan plan_of(const CompiledScene& scene, const RenderOptions& options) {
  return {scene.sampling,
          scene.info.samples,
          options.noise,
          show_surfaces(options.aovs),
          aov_layout(options.aovs).sums() > 0,
          clear_materials(scene)};
}

FilmNeeds needs_of(const CompiledScene& scene, const RenderOptions& options) {
  FilmNeeds needs = film_needs(options.aovs);
  needs.shows_surfaces |= needs_surfaces(scene.sampling);
  needs.grows = in_passes(scene.sampling);
  needs.keeps_earlier =
      needs.grows && (options.noise > 0 || std::ranges::count(options.aovs, "variance") > 0 ||
                      !checkpoint_path(options).empty());
  return needs;
}

std::vector<DeviceSpeed> speeds_of(const std::vector<WorkerPlan>& devices, const RenderOptions& options) {
  std::vector<DeviceSpeed> speeds(devices.size());
  for (std::size_t i = 0; i < devices.size(); ++i) {
    speeds[i].estimate = devices[i].info.estimate;
    speeds[i].processor = devices[i].processor;
    speeds[i].measured = devices[i].pixels_a_second;
    speeds[i].sample = devices[i].measured_pixels;
    if (options.tuning) speeds[i].tile_seconds = 1e-3 * options.tuning(devices[i].info).tile_ms;
  }
  return speeds;
}

/// Begins the first pass, or what a checkpoint leaves of one.
void begin_passes(Frame& frame) {
  const std::filesystem::path& file = frame.options.resume;
  if (!file.empty() && is_there(file)) {
    read_checkpoint(file, frame.film, frame.pass, frame.made, frame.key);
    if (frame.pass.is_none() && frame.film.grows) return begin_pass(frame, std::nullopt);
    if (frame.pass.is_none()) {  // it may be of another part of the frame
      frame.made = std::exchange(frame.film, Film(frame.film.width, frame.film.height, frame.film));
      frame.pass = *next_pass(frame.film, frame.plan);
    }
    if (!may_be_of(frame.plan, frame.pass)) throw damaged_checkpoint(file);
    continue_pass(frame);
  } else {
    begin_pass(frame, next_pass(frame.film, frame.plan));
  }
  frame.pixels_kept = frame.pixels_done;
  plan_next_pass(frame);
}

std::shared_ptr<Frame> begin_frame(const Scene& scene, const std::vector<WorkerPlan>& devices,
                                   const RenderOptions& options, std::uint64_t key) {
  const Tile area = area_of(*scene, options);
  auto frame = std::make_shared<Frame>(options, plan_of(*scene, options),
                                       Film(area.width, area.height, needs_of(*scene, options)),
                                       speeds_of(devices, options));
  frame->tiles = [options, shares = estimates(devices)](const Film& made) {
    return plan_tiles(options, made, shares);
  };
  for (const WorkerPlan& device : devices) {
    Frame::Worker worker;
    worker.device = device.make(frame->options);
    worker.report.info = device.info;
    frame->workers.push_back(std::move(worker));
  }
  frame->area = area;
  frame->inner = options.region.value_or(area);
  frame->inner.x -= area.x, frame->inner.y -= area.y;
  frame->key = key;
  begin_passes(*frame);
  return frame;
}

/// The same without a checkpoint that does not fit, if the options want that; `left` says why it does not.
std::shared_ptr<Frame> begin_or_renew(const Scene& scene, const std::vector<WorkerPlan>& devices,
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
  std::uint64_t pixels = 0;
  for (const Frame::Worker& worker : frame.workers) pixels += worker.report.pixels;
  for (std::size_t i = 0; i < frame.workers.size(); ++i) {
    DeviceReport report = frame.workers[i].report;
    report.busy_seconds = frame.queue.work(i).busy_seconds;
    report.share =
        static_cast<double>(report.pixels) / static_cast<double>(std::max<std::uint64_t>(1, pixels));
    result.push_back(std::move(report));
  }
  return result;
}

double frame_efficiency(const Frame& frame) {
  std::vector<DeviceWork> work;
  for (std::size_t i = 0; i < frame.workers.size(); ++i) work.push_back(frame.queue.work(i));
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

/// Makes image and AOVs of the film.
void develop(const Frame& frame, RenderResult& result) {
  const RenderOptions& options = frame.options;
  if (options.channels == 0) return;
  result.image = result.film.develop(options.channels);
  for (const std::string& name : options.aovs) result.aovs[name] = result.film.develop_aov(name);
}

/// Leaves the region alone of what the frame has made.
void cut_to_region(const Frame& frame, RenderResult& result) {
  if (!frame.options.region) return;
  const auto cut = [&](Image& image) {
    image.data = cut_pixels(image.data, image.width, frame.inner, static_cast<std::size_t>(image.channels));
    image.width = frame.inner.width, image.height = frame.inner.height;
  };
  result.film = result.film.cut(frame.inner);
  cut(result.image);
  for (auto& [name, image] : result.aovs) cut(image);
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
  // With what there is of another pass, parts of the picture would have twice the samples of others.
  if (result.time_limited && frame.film.stage > 0) frame.made = Film();
  result.film = take_film(frame);
  develop(frame, result);
  cut_to_region(frame, result);
  result.efficiency = frame_efficiency(frame);
  result.counts = frame.counts;
  result.times = frame.times;
  if (frame.timed)
    result.times.build_kernels += first_launch_seconds(frame.workers[*frame.timed].report.kernels);
  result.times.readback = frame.readback;
  result.times.render = std::max(
      0.0, frame.clock.seconds() - result.times.build_kernels - result.times.upload - frame.readback);
  return result;
}

}  // namespace

RenderResult render_frame(const Scene& scene, const std::vector<WorkerPlan>& devices,
                          const RenderOptions& options,
                          const std::function<void(const std::shared_ptr<Frame>&)>& run) {
  check_aovs(options.aovs);
  check_variance(options.aovs, scene->sampling);
  check_light(options.aovs, *scene);
  if (devices.empty()) throw DeviceError("no device to render on");
  check_shares(options.split, devices);
  check_region(options.region, static_cast<int>(scene->info.width), static_cast<int>(scene->info.height));
  if (in_passes(scene->sampling) && options.part.count > 1)
    throw UsageError("a frame that is adaptive, subsampled or progressive is made whole: leave the part out");
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
  if (result.failure && !(options.keep_failed && has_pixels(*frame))) std::rethrow_exception(result.failure);
  return result;
}

}  // namespace sundog
