// The loop of frames: a thread for each device worker takes part in the frame in hand, from its queue of
// tiles to its film. Internal to the render layer.
#pragma once
#include <condition_variable>
#include <mutex>
#include <vector>

#include "base/driver_threads.h"
#include "render/frame/frame.h"

namespace sundog {

// How often a frame in hand is looked at for drivers that hang.
inline constexpr std::chrono::milliseconds look_again{50};

/// A frame for the loop.
struct FrameTask {
  std::shared_ptr<Frame> frame;
  std::shared_ptr<const CompiledScene> flat;  // null: the workers have the scene
  bool final = false;   // a caller waits for its end; it is never a draft, and no snapshot shows it
  bool closes = false;  // so is the loop: workers are closed behind it
};

/// A thread owns a device worker, with its device and store of kernels. Guarded by the loop's mutex.
struct DeviceThread {
  std::shared_ptr<DeviceWorker> worker;
  std::shared_ptr<SceneWorker> of_scenes;  // the same; null: its scene is the only one
  DriverThread driver;
  std::shared_ptr<FrameTask> seen;  // the last frame that it took part in
  bool opening = false;             // it may be in a driver's compiler
  bool closed = false;              // the worker, behind a frame
  bool leave = false, gone = false;
  bool abandoned = false;  // a frame did not wait for it, and nobody does
  // Speed in the last frame that was finished; 0: the thread rendered nothing.
  double pixels_a_second = 0, measured_pixels = 0;
};

/// Locks: a frame's mutex may be held when the loop's is taken, never the other way.
class FrameLoop : public std::enable_shared_from_this<FrameLoop> {
 public:
  FrameLoop() = default;
  virtual ~FrameLoop() = default;
  FrameLoop(const FrameLoop&) = delete;
  FrameLoop& operator=(const FrameLoop&) = delete;

  /// Starts a worker's thread. The caller holds the mutex once the loop runs.
  void add_thread(std::shared_ptr<DeviceWorker> worker);
  /// Renders a frame of the threads' workers to its end. With `wait`, every thread has left it on return.
  void run(const std::shared_ptr<FrameTask>& mine, bool wait);
  /// Abandons the frame in hand and ends the threads; one in a driver is left to its owner.
  void end();
  /// Abandons the frame in hand. The caller holds the mutex.
  void drop_frame();
  /// Wakes who waits for a change. The caller holds the mutex.
  void note() {
    ++revision;
    changed.notify_all();
  }

  mutable std::mutex mutex;  // for everything below
  mutable std::condition_variable changed;
  std::uint64_t revision = 0;
  std::shared_ptr<FrameTask> current;
  std::vector<std::shared_ptr<DeviceThread>> threads;
  std::vector<std::shared_ptr<DeviceThread>> leaving;
  bool closing = false;

 protected:
  // Other work of a thread, between frames and after an abandoned one. The caller holds the mutex by `lock`.
  virtual bool has_errand(const DeviceThread&) const { return false; }
  virtual void run_errand(std::unique_lock<std::mutex>&, DeviceThread&) {}
  virtual void after_frame(std::unique_lock<std::mutex>&, DeviceThread&, const std::shared_ptr<FrameTask>&) {}

 private:
  void run_thread(DeviceThread& thread);
  void serve(std::unique_lock<std::mutex>& lock, DeviceThread& thread, std::size_t index);
  std::optional<std::size_t> index_of(const DeviceThread& thread) const;
};

/// Makes the passes of a frame by threads of its workers, which are closed behind it. With `wait`, every
/// thread has ended on return; otherwise DeviceInfo::threads takes over the threads inside a driver.
void run_frame(const std::shared_ptr<Frame>& frame, bool wait);

}  // namespace sundog
