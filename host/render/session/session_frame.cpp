// Plans a session's frame, whose samples double from pass to pass so that the picture refines, and develops
// the picture so far.
#include "render/session/session_frame.h"

#include <algorithm>

namespace sundog {
namespace {

// How long a worker stays with one tile before it checks for a newer scene and picks and shows its pixels.
constexpr double tile_seconds = 0.2;

RenderOptions options_of(const SessionSettings& settings) {
  RenderOptions options;
  options.work_group = settings.work_group;
  options.tuning = settings.tuning;
  options.split = settings.split;
  options.tile = settings.tile;
  options.kernels = settings.general_kernels ? KernelChoice::own_when_built : KernelChoice::own;
  options.passes = true;
  options.tile_seconds = tile_seconds;
  return options;
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

/// Balances a pixel, if it has samples.
void balance_pixel(const Film& film, std::size_t i, std::span<const glm::vec3> balance, float* pixel) {
  if (balance.empty() || !film.layout.groups || film.aovs.empty() || !(film.weights[i] > 0)) return;
  const Color color = film.balanced_mean(i, balance);
  pixel[0] = color.r, pixel[1] = color.g, pixel[2] = color.b;
}

Image balanced_image(const Film& film, std::span<const glm::vec3> balance) {
  Image image = film.develop(4);
  for (std::size_t i = 0; i < film.done.size(); ++i)
    if (film.done[i]) balance_pixel(film, i, balance, image.data.data() + 4 * i);
  return image;
}

/// Copies the finished pixels of the current pass.
void fill_from_pass(const Frame& frame, std::span<const glm::vec3> balance, Image& image) {
  const Film& done = frame.pass_film;
  for (std::size_t i = 0; i < done.done.size(); ++i) {
    const std::int64_t p = done.done[i] ? image_index(frame.film, frame.pass, i) : -1;
    if (p < 0) continue;
    float* pixel = image.data.data() + 4 * p;
    std::fill_n(pixel, 4, 0.0f);
    set_pixel(pixel, done.sums[i], done.weights[i]);
    balance_pixel(done, i, balance, pixel);
  }
}

std::string doing_of(const Frame::Worker& worker, bool over) {
  if (worker.failed) return "out: " + (worker.report.messages.empty() ? "" : worker.report.messages.back());
  if (over) return "waiting";
  if (worker.phase == Frame::Phase::opening) return "building a kernel";
  return worker.device->compiles() ? "building a kernel" : "drawing";
}

}  // namespace

WorkerPlan plan_kept(const std::shared_ptr<DeviceWorker>& worker) {
  return {worker->info(), worker->processor(), [worker](const RenderOptions&) { return worker; }};
}

std::shared_ptr<Frame> make_session_frame(const FrameOrder& order,
                                          std::function<void(const RenderProgress&)> on_progress) {
  RenderOptions options = options_of(order.settings);
  options.on_progress = std::move(on_progress);
  options.aovs = order.aovs;
  std::vector<WorkerPlan> workers;
  for (const auto& worker : order.workers) workers.push_back(plan_kept(worker));
  auto frame = plan_frame(*order.scene, workers, options);
  frame->live = true;
  frame->coarse.pixel_seconds = order.pixel_seconds;
  begin_coarse(*frame, order.settings.coarse ? first_block(order.pixel_seconds, frame->film.pixels()) : 0);
  return frame;
}

FrameProgress progress_of(const Frame& frame) {
  const int block = frame.coarse.picture.block;
  FrameProgress progress;
  progress.pass = frame.coarse.count + frame.film.stage;
  progress.settled = frame.queue.complete();
  progress.full = frame.film.stage > 0;
  progress.whole = progress.full || block > 0;
  progress.block = progress.full || block == 0 ? 1 : static_cast<unsigned>(block);
  return progress;
}

FrameSamples samples_of(const Frame& frame, unsigned wanted) {
  if (frame.queue.complete()) return {wanted, 1};
  double all = 0;
  u32 least = ~0u;
  for (const u32 samples : frame.film.taken) {
    all += samples;
    least = std::min(least, samples);
  }
  if (frame.coarse.block == 0) all += static_cast<double>(frame.pixels_done) * frame.pass.sample_count;
  constexpr double most = 0.999;  // 1 is settled
  const double wanted_in_all = static_cast<double>(frame.film.pixels()) * std::max(1u, wanted);
  return {frame.film.stage > 0 ? least : 0, std::min(most, all / wanted_in_all)};
}

Image picture_of(const Frame& frame, std::span<const glm::vec3> balance) {
  const Film& film = frame.film;
  const CoarsePasses& coarse = frame.coarse;
  if (frame.pass_film.done.empty()) return balanced_image(film, balance);
  if (frame.plan.settings.subsample && coarse.block == 0 && film.stage > 0)
    return balanced_image(film_so_far(frame), balance);
  Image image = film.stage > 0 ? balanced_image(film, balance) : Image(film.width, film.height, 4);
  if (film.stage == 0 && coarse.picture.block > 0) fill_coarse(coarse.picture, image);
  if (coarse.block == 0) fill_from_pass(frame, balance, image);
  return image;
}

std::vector<DeviceActivity> activity_of(const Frame& frame, bool over) {
  std::vector<DeviceActivity> list;
  for (DeviceReport& report : reports(frame))
    list.push_back({std::move(report), doing_of(frame.workers[list.size()], over)});
  return list;
}

}  // namespace sundog
