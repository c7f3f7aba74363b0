// One device that renders one scene again and again, for timing whole frames: a session of that device.
#pragma once
#include <memory>

#include "render/session/render_session.h"

namespace sundog {

class DeviceServer;

/// Kernels are built and tables uploaded once. The scene must outlive it.
class FrameRunner {
 public:
  /// Throws DeviceError, BuildError, UsageError as render() does.
  FrameRunner(const DeviceInfo& device, const CompiledScene& scene, const RenderOptions& options = {});
  FrameRunner(const FrameRunner&) = delete;
  FrameRunner& operator=(const FrameRunner&) = delete;

  /// Renders the frame as `sundog render` does, and returns the wall seconds from when the device has kernels
  /// and tables until the film is on the host. Throws DeviceError for a launch that failed, even if the frame
  /// was finished without it: the time would not be that of what was asked for.
  double run();

  /// For the runs from now on. The size must be one that render() would take.
  void use(const WorkGroup& group) { options_.work_group = group; }

  /// The largest work-group that its kernels allow; 0: unknown.
  std::size_t greatest_group() const;

  /// Of the last run: on the device, of all launches of a kernel; by the host's clock where the driver gives
  /// no times.
  double kernel_seconds(const std::string& kernel) const;
  /// Of the last run, for each kernel.
  const std::map<std::string, KernelTimes>& kernel_times() const { return kernel_times_; }
  const Film& film() const { return last_.film; }
  Image image() const { return last_.film.develop(); }
  const RayCounts& counts() const { return last_.counts; }

  /// Kernels and tables; not part of any run.
  const RenderTimes& times() const { return times_; }

 private:
  std::shared_ptr<const CompiledScene> scene_;
  RenderOptions options_;
  std::shared_ptr<DeviceServer> server_;
  RenderTimes times_;
  RenderSession session_;
  RenderResult last_;
  std::map<std::string, KernelTimes> kernel_times_;
};

}  // namespace sundog
