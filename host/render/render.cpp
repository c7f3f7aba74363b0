#include "render/render.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <mutex>
#include <thread>

#include "base/clock.h"
#include "base/error.h"
#include "render/film.h"
#include "render/hash.h"
#include "render/tile_queue.h"
#include "render/tile_renderer.h"
#include "render/tiles.h"

namespace sundog {
namespace {

constexpr std::uint64_t failures_until_retired = 3;

// What the devices' threads share. Everything behind the mutex but the queue, which has its own.
struct Frame {
  const CompiledScene& scene;
  const RenderOptions& options;
  TileQueue queue;
  std::mutex mutex;
  Film film;
  RenderResult result;
  std::exception_ptr last_error;
  std::size_t working;  // devices that are not retired
  std::uint64_t pixels_done;
  Stopwatch clock;
  bool timed = false;  // the first device to be ready has set the frame's build and upload times
  double readback = 0;
};

void report_progress(Frame& frame) {
  if (!frame.options.on_progress) return;
  const auto total = static_cast<std::uint64_t>(frame.film.done.size());
  frame.options.on_progress({frame.pixels_done, total, frame.clock.seconds()});
}

void keep_tile(Frame& frame, const TileResult& tile_result) {
  const std::lock_guard lock(frame.mutex);
  frame.film.put(tile_result.tile, tile_result.sums, tile_result.weights, tile_result.aovs);
  for (std::size_t i = 0; i < COUNTERS; ++i) frame.result.counts[i] += tile_result.counts[i];
  frame.pixels_done += static_cast<std::uint64_t>(tile_result.tile.width) *
                       static_cast<std::uint64_t>(tile_result.tile.height);
  report_progress(frame);
}

// Takes tiles until there are none, the frame is stopped, or the device has failed too often.
void work(Frame& frame, TileRenderer& renderer, DeviceReport& report) {
  while (const std::optional<Tile> tile = frame.queue.take()) {
    const Stopwatch busy;
    try {
      const TileResult tile_result = renderer.render(*tile);
      report.busy_seconds += busy.seconds();
      keep_tile(frame, tile_result);
      if (tile_result.tile != *tile) {  // stopped on the way
        frame.queue.close();
        return;
      }
      report.tiles += 1;
      frame.queue.finished();
    } catch (const DeviceError& error) {
      frame.queue.give_back(*tile);
      report.messages.push_back(error.what());
      if (++report.failures >= failures_until_retired) throw;
    }
  }
}

void serve(Frame& frame, DeviceReport& report) {
  try {
    Device device(report.info);
    RenderTimes times;
    TileRenderer renderer(device, frame.scene, frame.options, times);
    report.kernels_cached = times.cached;
    {
      const std::lock_guard lock(frame.mutex);
      if (!frame.timed) frame.result.times = times;
      frame.timed = true;
    }
    work(frame, renderer, report);
    report.kernels = device.times();
    const std::lock_guard lock(frame.mutex);
    frame.readback = std::max(frame.readback, renderer.readback_seconds());
  } catch (const std::exception& error) {
    const std::lock_guard lock(frame.mutex);
    report.retired = true;
    if (report.messages.empty() || report.messages.back() != error.what())
      report.messages.push_back(error.what());
    frame.last_error = std::current_exception();
    if (--frame.working == 0) frame.queue.close();
  }
}

std::vector<Tile> plan_tiles(const RenderOptions& options, const Film& film, std::size_t devices) {
  const int width = film.width, height = film.height;
  const int edge = options.tile > 0 ? options.tile : default_tile_edge(width, height, devices);
  std::vector<Tile> tiles = cut_tiles(width, height, edge);
  std::erase_if(tiles, [&](const Tile& tile) { return film.is_done(tile); });
  return tiles;
}

void check_aovs(const std::vector<std::string>& names) {
  for (const std::string& name : names)
    if (std::find(aov_names().begin(), aov_names().end(), name) == aov_names().end())
      throw UsageError(
          fmt::format("no AOV is called '{}'; there are {}", name, fmt::join(aov_names(), ", ")));
}

// Gathers the finished film, or what there is of it, and keeps the checkpoint in step.
void finish_frame(Frame& frame, std::uint64_t key) {
  RenderResult& result = frame.result;
  result.complete =
      std::all_of(frame.film.done.begin(), frame.film.done.end(), [](auto d) { return d != 0; });
  result.image = frame.film.develop();
  for (const std::string& name : frame.options.aovs) result.aovs[name] = frame.film.develop_aov(name);
  const double total = frame.clock.seconds();
  result.times.readback = frame.readback;
  result.times.render =
      std::max(0.0, total - result.times.build_kernels - result.times.upload - frame.readback);
  if (!frame.options.resume.empty() && !result.complete)
    write_checkpoint(frame.options.resume, frame.film, key);
}

}  // namespace

RenderResult render(const CompiledScene& scene, const std::vector<DeviceInfo>& devices,
                    const RenderOptions& options) {
  check_aovs(options.aovs);
  if (devices.empty()) throw DeviceError("no device to render on");
  Film film(static_cast<int>(scene.info.width), static_cast<int>(scene.info.height), !options.aovs.empty());
  const std::uint64_t key = options.resume.empty() ? 0 : hash_scene(scene);
  if (!options.resume.empty() && std::filesystem::exists(options.resume))
    read_checkpoint(options.resume, film, key);
  std::vector<Tile> tiles = plan_tiles(options, film, devices.size());
  const auto done = static_cast<std::uint64_t>(
      std::count_if(film.done.begin(), film.done.end(), [](auto d) { return d != 0; }));
  Frame frame{
      scene, options, TileQueue(std::move(tiles)), {}, std::move(film), {}, {}, devices.size(), done, {},
      false, 0};
  std::vector<DeviceReport> reports(devices.size());
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < devices.size(); ++i) {
    reports[i].info = devices[i];
    threads.emplace_back([&frame, &report = reports[i]] { serve(frame, report); });
  }
  for (std::thread& thread : threads) thread.join();
  frame.result.devices = std::move(reports);
  const bool stopped = options.stop && options.stop->load();
  if (frame.queue.left() > 0 && !stopped && frame.last_error) std::rethrow_exception(frame.last_error);
  finish_frame(frame, key);
  return std::move(frame.result);
}

}  // namespace sundog
