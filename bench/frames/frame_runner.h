// Renders one scene repeatedly on given devices, in one session, to time whole frames.
#pragma once
#include <memory>
#include <vector>

#include "bench/runs/measure.h"
#include "render/session/render_session.h"

namespace sundog {

class LocalWorker;

/// A device for FrameRunners, which open it. Runners may share it, one at a time.
std::shared_ptr<LocalWorker> frame_worker(const DeviceInfo& device,
                                          const std::shared_ptr<const CompiledScene>& scene);

/// Builds kernels and uploads tables once. A scene passed by reference must outlive the runner.
class FrameRunner {
 public:
  /// Throws DeviceError, BuildError, UsageError as render() does.
  FrameRunner(const DeviceInfo& device, const CompiledScene& scene, const RenderOptions& options = {});
  FrameRunner(std::vector<std::shared_ptr<LocalWorker>> workers, std::shared_ptr<const CompiledScene> scene,
              const RenderOptions& options = {});
  FrameRunner(const FrameRunner&) = delete;
  FrameRunner& operator=(const FrameRunner&) = delete;

  /// Renders the frame as `sundog render` does. Returns the wall-clock seconds from when the devices have
  /// kernels and tables until the film is on the host; 0 if options.stop ended the frame. Throws DeviceError
  /// for a failed launch or a work-group that the driver refuses, even if the frame was finished: its time
  /// would belong to other settings.
  double run();

  /// Sets the work-group of later runs. render() must accept its size.
  void use(const WorkGroup& group) { options_.work_group = group; }

  /// The largest work-group that the first device's kernels allow; 0: unknown.
  std::size_t greatest_group() const;

  /// Seconds of a kernel's launches on the first device in the last run; by device events, or by the host's
  /// clock if the driver gives no times.
  double kernel_seconds(const std::string& kernel) const;
  double kernel_seconds() const;  // of all kernels
  /// Each kernel's times on the first device in the last run.
  const std::map<std::string, KernelTimes>& kernel_times() const { return kernel_times_; }
  const Film& film() const { return last_.film; }
  Image image() const { return last_.film.develop(); }
  const RenderResult& last() const { return last_; }
  /// Number of rays of the last run: primary, reflected, refracted and shadow rays, and rays that only find a
  /// pixel's surface.
  double rays() const;
  const RayCounts& counts() const { return last_.counts; }

  /// Times of building kernels and uploading tables, which no run includes.
  const RenderTimes& times() const { return times_; }

 private:
  std::shared_ptr<const CompiledScene> scene_;
  RenderOptions options_;
  std::vector<std::shared_ptr<LocalWorker>> workers_;
  RenderTimes times_;
  RenderSession session_;
  RenderResult last_;
  std::map<std::string, KernelTimes> kernel_times_;
};

/// A way of a bench that renders frames: `open` makes the runner before the first run, `first` is called
/// after the first frame. A later frame counts only if it has the same bits as the first.
struct FrameSubject {
  std::function<std::shared_ptr<FrameRunner>()> open;
  std::function<void(FrameRunner&)> first;
  std::function<double(const FrameRunner&)> seconds;  // of the last run; empty: the frame's
  std::vector<DeviceInfo> devices;                    // Subject::devices
};
Subject frame_subject(const std::string& name, FrameSubject of);

/// Whether both images have the same bits.
bool same_bits_of(const Image& a, const Image& b);

/// A reference image that two successive frames agree on (confirmed()).
Image confirmed_image(FrameRunner& frames);

}  // namespace sundog
