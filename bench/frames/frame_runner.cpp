// Opens the devices' workers in a session, renders frames and compares their bits.
#include "bench/frames/frame_runner.h"

#include <fmt/format.h>

#include <cstring>

#include "base/error.h"
#include "render/frame/local_worker.h"

namespace sundog {
namespace {

using Scene = std::shared_ptr<const CompiledScene>;
using LocalWorkers = std::vector<std::shared_ptr<LocalWorker>>;

/// Opens the devices at once, so that errors appear before any frame.
RenderTimes open_all(const LocalWorkers& workers, const Scene& scene, const RenderOptions& options) {
  RenderTimes sum;
  sum.cached = true;
  for (const auto& worker : workers) {
    worker->show(scene, options);
    const RenderTimes times = worker->open();
    sum.build_kernels += times.build_kernels;
    sum.upload += times.upload;
    sum.cached = sum.cached && times.cached;
  }
  return sum;
}

/// Benches develop the film themselves when they want an image, outside of a frame's time.
RenderOptions without_pictures(RenderOptions options) {
  options.channels = 0;
  return options;
}

}  // namespace

std::shared_ptr<LocalWorker> frame_worker(const DeviceInfo& device, const Scene& scene) {
  static const RenderOptions usual;
  return std::make_shared<LocalWorker>(device, scene, usual);
}

FrameRunner::FrameRunner(const DeviceInfo& device, const CompiledScene& scene, const RenderOptions& options)
    : FrameRunner({frame_worker(device, Scene(std::shared_ptr<void>(), &scene))},
                  Scene(std::shared_ptr<void>(), &scene), options) {}

FrameRunner::FrameRunner(LocalWorkers workers, Scene scene, const RenderOptions& options)
    : scene_(std::move(scene)),
      options_(without_pictures(options)),
      workers_(std::move(workers)),
      times_(open_all(workers_, scene_, options_)),
      session_(std::vector<std::shared_ptr<SceneWorker>>(workers_.begin(), workers_.end())) {}

std::size_t FrameRunner::greatest_group() const { return workers_.front()->greatest_group(); }

double FrameRunner::run() {
  last_ = session_.render(scene_, options_);
  if (!last_.complete) return 0;  // options.stop
  for (const DeviceReport& report : last_.devices)
    if (!report.messages.empty()) throw DeviceError(report.messages.front());
  kernel_times_ = last_.devices.front().kernels;
  // A group that the driver refused was made smaller, so the time would belong to another group.
  const WorkGroup& group = options_.work_group;
  const std::size_t most = greatest_group();
  if (group.kind == WorkGroup::Kind::fixed && most > 0 && group.x * group.y > most)
    throw DeviceError(fmt::format("the driver takes groups of at most {} here", most));
  return last_.times.render + last_.times.readback;
}

double FrameRunner::kernel_seconds(const std::string& kernel) const {
  const auto found = kernel_times_.find(kernel);
  if (found == kernel_times_.end()) return 0;
  return 1e-3 * (found->second.device_ms > 0 ? found->second.device_ms : found->second.host_ms);
}

double FrameRunner::kernel_seconds() const {
  double sum = 0;
  for (const auto& [name, times] : kernel_times_) sum += kernel_seconds(name);
  return sum;
}

double FrameRunner::rays() const {
  auto rays = static_cast<double>(last_.film.surfaces_seen);
  for (const int kind : {COUNT_PRIMARY, COUNT_REFLECTION, COUNT_REFRACTION, COUNT_SHADOW})
    rays += static_cast<double>(last_.counts[static_cast<std::size_t>(kind)]);
  return rays;
}

bool same_bits_of(const Image& a, const Image& b) {
  return a.data.size() == b.data.size() &&
         std::memcmp(a.data.data(), b.data.data(), a.data.size() * sizeof(float)) == 0;
}

Image confirmed_image(FrameRunner& frames) {
  const auto image = [&] {
    frames.run();
    return frames.image();
  };
  return confirmed<Image>(image, same_bits_of);
}

Subject frame_subject(const std::string& name, FrameSubject of) {
  struct State {
    std::shared_ptr<FrameRunner> frames;
    Image first;
  };
  const auto state = std::make_shared<State>();
  Subject subject;
  subject.name = name;
  subject.devices = std::move(of.devices);
  subject.prepare = [state, open = std::move(of.open)] { state->frames = open(); };
  subject.run = [state, seconds = std::move(of.seconds)] {
    const double frame = state->frames->run();
    return seconds ? seconds(*state->frames) : frame;
  };
  subject.check = [state, first = std::move(of.first)]() -> std::string {
    Image image = state->frames->image();
    if (!state->first.data.empty())
      return same_bits_of(image, state->first) ? "" : "its image is not that of its first run";
    state->first = std::move(image);
    if (first) first(*state->frames);
    return "";
  };
  return subject;
}

}  // namespace sundog
