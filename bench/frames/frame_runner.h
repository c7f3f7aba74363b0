// Devices that render one scene again and again, for timing whole frames: a session of those devices.
#pragma once
#include <memory>
#include <vector>

#include "bench/runs/measure.h"
#include "render/session/render_session.h"

namespace sundog {

class LocalWorker;

/// An open device, or one that a FrameRunner opens. Runners may share it, one at a time.
std::shared_ptr<LocalWorker> frame_worker(const DeviceInfo& device,
                                          const std::shared_ptr<const CompiledScene>& scene);

/// Kernels are built and tables uploaded once. The scene must outlive it.
class FrameRunner {
 public:
  /// Throws DeviceError, BuildError, UsageError as render() does.
  FrameRunner(const DeviceInfo& device, const CompiledScene& scene, const RenderOptions& options = {});
  FrameRunner(std::vector<std::shared_ptr<LocalWorker>> workers, std::shared_ptr<const CompiledScene> scene,
              const RenderOptions& options = {});
  FrameRunner(const FrameRunner&) = delete;
  FrameRunner& operator=(const FrameRunner&) = delete;

  /// Renders the frame as `sundog render` does, and returns the wall seconds from when the devices have
  /// kernels and tables until the film is on the host. Throws DeviceError for a launch that failed, even if
  /// the frame was finished without it: the time would not be that of what was asked for. 0 where
  /// options.stop ended it.
  double run();

  /// For the runs from now on. The size must be one that render() would take.
  void use(const WorkGroup& group) { options_.work_group = group; }

  /// The largest work-group that the first device's kernels allow; 0: unknown.
  std::size_t greatest_group() const;

  /// Seconds of a kernel's launches on the first device in the last run; by the host's clock where the driver
  /// gives no times.
  double kernel_seconds(const std::string& kernel) const;
  double kernel_seconds() const;  // of all kernels
  /// Times of each kernel of the first device in the last run.
  const std::map<std::string, KernelTimes>& kernel_times() const { return kernel_times_; }
  const Film& film() const { return last_.film; }
  Image image() const { return last_.film.develop(); }
  const RenderResult& last() const { return last_; }
  /// Rays of the last run: primary, reflected, refracted, shadow rays and those that only looked.
  double rays() const;
  const RayCounts& counts() const { return last_.counts; }

  /// Kernels and tables; not part of any run.
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

/// A way of a bench that renders frames: `open` makes the runner before the first run,
/// `first` hears of the first frame. A later frame that is not the first one to the bit does not count.
struct FrameSubject {
  std::function<std::shared_ptr<FrameRunner>()> open;
  std::function<void(FrameRunner&)> first;
  std::function<double(const FrameRunner&)> seconds;  // of the last run; empty: the frame's
};
Subject frame_subject(const std::string& name, FrameSubject of);

/// Whether both have the same bits.
bool same_bits_of(const Image& a, const Image& b);

/// A reference picture: one that two frames in a row agree on (confirmed()).
Image confirmed_image(FrameRunner& frames);

}  // namespace sundog
