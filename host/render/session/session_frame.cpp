#include "render/session/session_frame.h"

#include <fmt/format.h>

#include <algorithm>

#include "render/plan/frame_tiles.h"

namespace sundog {
namespace {

// So long a server is with one tile: then it looks for a newer scene, for picks, and shows its pixels.
constexpr double tile_seconds = 0.2;

RenderOptions options_of(const SessionSettings& settings) {
  RenderOptions options;
  options.work_group = settings.work_group;
  options.tuning = settings.tuning;
  options.split = settings.split;
  options.tile = settings.tile;
  options.kernels = settings.general_kernels ? KernelChoice::own_when_built : KernelChoice::own;
  return options;
}

/// Samples of a scene that is not made in passes of its own double from pass to pass: sums grow in the order
/// in which one pass would add them.
SamplingPlan sampling_of(const CompiledScene& scene) {
  SamplingPlan plan{scene.sampling, scene.info.samples};
  plan.panes = clear_materials(scene);
  if (!in_passes(scene.sampling)) plan.settings.progressive = true;
  return plan;
}

std::vector<DeviceSpeed> speeds_of(const std::vector<std::shared_ptr<SceneServer>>& servers) {
  std::vector<DeviceSpeed> speeds(servers.size());
  for (std::size_t i = 0; i < servers.size(); ++i) {
    speeds[i].estimate = servers[i]->info().estimate;
    speeds[i].processor = servers[i]->processor();
    speeds[i].tile_seconds = tile_seconds;
  }
  return speeds;
}

FramePasses passes_of(const FrameOrder& order, const RenderOptions& options) {
  FramePasses passes;
  const SceneInfo& info = order.scene->info;
  passes.plan = sampling_of(*order.scene);
  passes.film = GrowingFilm(static_cast<int>(info.width), static_cast<int>(info.height),
                            needs_surfaces(order.scene->sampling), AovLayout(), false);
  std::vector<double> estimates;
  for (const auto& server : order.servers) estimates.push_back(server->info().estimate);
  passes.tiles = [options, estimates](const Film& film) { return plan_tiles(options, film, estimates); };
  return passes;
}

void set_pixel(float* pixel, const float4& sum, float weight) {
  if (!(weight > 0)) return;
  pixel[0] = sum.x / weight;
  pixel[1] = sum.y / weight;
  pixel[2] = sum.z / weight;
  pixel[3] = sum.w / weight;
}

void fill_coarse(const CoarsePicture& coarse, Image& image) {
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const float4& color = coarse.at(x, y);
      std::copy_n(&color.x, 4, image.pixel(x, y));
    }
}

/// The pixels of the pass in hand that are done.
void fill_from_pass(const FramePasses& passes, const Film& made, Image& image) {
  for (std::size_t i = 0; i < made.done.size(); ++i) {
    const std::int64_t p = made.done[i] ? image_index(passes.film, passes.pass, i) : -1;
    if (p < 0) continue;
    float* pixel = image.data.data() + 4 * p;
    std::fill_n(pixel, 4, 0.0f);
    set_pixel(pixel, made.sums[i], made.weights[i]);
  }
}

std::string doing_of(const Frame::Server& server, bool over) {
  if (server.failed) return "out: " + (server.report.messages.empty() ? "" : server.report.messages.back());
  if (over) return "waiting";
  if (server.phase == Frame::Phase::opening) return "building a kernel";
  return server.server->compiles() ? "building a kernel" : "drawing";
}

}  // namespace

std::shared_ptr<Frame> make_session_frame(const FrameOrder& order,
                                          std::function<void(const RenderProgress&)> on_progress) {
  RenderOptions options = options_of(order.settings);
  FramePasses passes = passes_of(order, options);
  const std::size_t pixels = passes.film.taken.size();
  options.on_progress = std::move(on_progress);
  auto frame = std::make_shared<Frame>(options, Film(), TilePlan{{WaitingTiles()}}, speeds_of(order.servers));
  for (const auto& server : order.servers) {
    Frame::Server entry;
    entry.server = server;
    entry.report.info = server->info();
    frame->servers.push_back(std::move(entry));
  }
  frame->live = true;
  passes.pixel_seconds = order.pixel_seconds;
  frame->passes = std::move(passes);
  begin_coarse(*frame, order.settings.coarse ? first_block(order.pixel_seconds, pixels) : 0);
  frame->queue.expect_more();
  frame->queue.refill(frame->passes->tiles(frame->film));
  return frame;
}

FrameProgress progress_of(const Frame& frame) {
  const FramePasses& passes = *frame.passes;
  FrameProgress progress;
  progress.pass = passes.coarse_passes + passes.film.stage;
  progress.settled = frame.queue.complete();
  progress.full = passes.film.stage > 0;
  progress.whole = progress.full || passes.coarse.block > 0;
  progress.block = progress.full || passes.coarse.block == 0 ? 1 : static_cast<unsigned>(passes.coarse.block);
  return progress;
}

FrameSamples samples_of(const Frame& frame, unsigned wanted) {
  if (frame.queue.complete()) return {wanted, 1};
  if (!frame.passes)
    return {0, static_cast<double>(frame.pixels_done) /
                   static_cast<double>(std::max<std::size_t>(1, frame.film.done.size()))};
  const FramePasses& passes = *frame.passes;
  const std::vector<u32>& taken = passes.film.taken;
  double all = 0;
  u32 least = ~0u;
  for (const u32 samples : taken) {
    all += samples;
    least = std::min(least, samples);
  }
  if (passes.coarse_block == 0) all += static_cast<double>(frame.pixels_done) * passes.pass.sample_count;
  constexpr double most = 0.999;  // 1 is settled
  const double wanted_in_all = static_cast<double>(taken.size()) * std::max(1u, wanted);
  return {passes.film.stage > 0 ? least : 0, std::min(most, all / wanted_in_all)};
}

Image picture_of(const Frame& frame) {
  const FramePasses& passes = *frame.passes;
  if (frame.film.done.empty()) return passes.film.film.develop(4);
  if (passes.plan.settings.subsample && passes.coarse_block == 0) {
    if (passes.film.stage > 0) return film_so_far(frame).film.develop(4);
  }
  Image image = passes.film.stage > 0 ? passes.film.film.develop(4)
                                      : Image(passes.film.film.width, passes.film.film.height, 4);
  if (passes.film.stage == 0 && passes.coarse.block > 0) fill_coarse(passes.coarse, image);
  if (passes.coarse_block == 0) fill_from_pass(passes, frame.film, image);
  return image;
}

std::vector<DeviceActivity> activity_of(const Frame& frame, bool over) {
  std::vector<DeviceActivity> list;
  std::uint64_t all = 0;
  for (const Frame::Server& server : frame.servers) all += server.report.pixels;
  for (std::size_t i = 0; i < frame.servers.size(); ++i) {
    const Frame::Server& server = frame.servers[i];
    const DeviceReport& report = server.report;
    DeviceActivity activity;
    activity.info = report.info;
    activity.doing = doing_of(server, over);
    activity.tiles = report.tiles, activity.pixels = report.pixels;
    activity.share = all > 0 ? static_cast<double>(report.pixels) / static_cast<double>(all) : 0;
    activity.busy_seconds = frame.queue.work(i).busy_seconds;
    activity.kernels = report.kernels;
    activity.messages = report.messages;
    activity.notes = report.notes;
    list.push_back(std::move(activity));
  }
  return list;
}

}  // namespace sundog
