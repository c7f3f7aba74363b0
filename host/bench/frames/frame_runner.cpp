// See frame_runner.h.
#include "bench/frames/frame_runner.h"

#include <fmt/format.h>

#include "base/error.h"
#include "render/device/device_server.h"

namespace sundog {
namespace {

/// Opened here, so that what keeps it from working is known before any frame.
RenderTimes open(DeviceServer& server, const std::shared_ptr<const CompiledScene>& scene,
                 const RenderOptions& options) {
  server.show(scene, options);
  return server.open();
}

/// A bench develops the film where it wants a picture: that is no part of a frame's time.
RenderOptions without_pictures(RenderOptions options) {
  options.channels = 0;
  return options;
}

}  // namespace

FrameRunner::FrameRunner(const DeviceInfo& device, const CompiledScene& scene, const RenderOptions& options)
    : scene_(std::shared_ptr<void>(), &scene),
      options_(without_pictures(options)),
      server_(std::make_shared<DeviceServer>(device, scene_, options_)),
      times_(open(*server_, scene_, options_)),
      session_(std::vector<std::shared_ptr<SceneServer>>{server_}) {}

std::size_t FrameRunner::greatest_group() const { return server_->greatest_group(); }

double FrameRunner::run() {
  last_ = session_.render(scene_, options_);
  const DeviceReport& report = last_.devices.front();
  if (!report.messages.empty()) throw DeviceError(report.messages.front());
  kernel_times_ = report.kernels;
  // A group that the driver refused was made smaller: the time is not that of what was asked for.
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

}  // namespace sundog
