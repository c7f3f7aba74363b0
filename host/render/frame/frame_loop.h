// The loop of frames: one thread per device worker renders tiles of the current frame. Internal to the render
// layer.
#pragma once
#include <condition_variable>
#include <mutex>
#include <vector>

#include "base/driver_threads.h"
#include "render/frame/frame.h"

namespace sundog {

// How often the current frame is checked for hanging drivers.
inline constexpr std::chrono::milliseconds look_again{50};

/// A frame to be rendered by the loop.
struct FrameTask {
  std::shared_ptr<Frame> frame;
  std::shared_ptr<const CompiledScene> flat;  // null: the workers already have the scene
  bool final = false;   // a caller waits for its end; it is never a draft, and no snapshot shows it
  bool closes = false;  // the loop ends with it: workers are closed
};

/// A thread that owns a device worker, with its device and kernel store. Guarded by the loop's mutex.
struct DeviceThread {
  std::shared_ptr<DeviceWorker> worker;
  std::shared_ptr<SceneWorker> of_scenes;  // `worker`, if it can change scenes; otherwise null
  DriverThread driver;
  std::shared_ptr<FrameTask> seen;  // the last frame that it worked on
  bool opening = false;             // it may be in a driver's compiler
  bool opened = false;              // since it left `seen`: its worker has that frame's scene
  bool closed = false;              // the worker was closed after a frame
  bool leave = false, gone = false;
  bool abandoned = false;  // a frame did not wait for it, and nobody will
  // Speed in the last finished frame; 0: the thread rendered nothing.
  double pixels_a_second = 0, measured_pixels = 0;
};

/// Lock order: a frame's mutex may be held when the loop's is locked, never the reverse.
class FrameLoop : public std::enable_shared_from_this<FrameLoop> {
 public:
  FrameLoop() = default;
  virtual ~FrameLoop() = default;
  FrameLoop(const FrameLoop&) = delete;
  FrameLoop& operator=(const FrameLoop&) = delete;

  /// Starts a worker's thread. Once the loop runs, the caller holds the mutex.
  void add_thread(std::shared_ptr<DeviceWorker> worker);
  /// Renders a frame to its end with the threads' workers. With `wait`, every thread has left it on return.
  void run(const std::shared_ptr<FrameTask>& mine, bool wait);
  /// Abandons the current frame and ends the threads; a thread in a driver is handed to DeviceInfo::threads.
  void end();
  /// Abandons the current frame. The caller holds the mutex.
  void drop_frame();
  /// Wakes everyone who waits for a change. The caller holds the mutex.
  void note() {
    ++revision;
    changed.notify_all();
  }

  mutable std::mutex mutex;  // guards everything below
  mutable std::condition_variable changed;
  std::uint64_t revision = 0;
  std::shared_ptr<FrameTask> current;
  std::vector<std::shared_ptr<DeviceThread>> threads;
  std::vector<std::shared_ptr<DeviceThread>> leaving;
  bool closing = false;

 protected:
  // A thread's other work, between frames and after an abandoned frame. The caller holds the mutex through
  // `lock`.
  virtual bool has_errand(const DeviceThread&) const { return false; }
  virtual void run_errand(std::unique_lock<std::mutex>&, DeviceThread&) {}
  virtual void after_frame(std::unique_lock<std::mutex>&, DeviceThread&, const std::shared_ptr<FrameTask>&) {}

  /// The thread's worker in the current frame.
  std::optional<std::size_t> index_of(const DeviceThread& thread) const;

 private:
  void run_thread(DeviceThread& thread);
  void work_on_current(std::unique_lock<std::mutex>& lock, DeviceThread& thread, std::size_t index);
};

/// Renders a frame's passes in threads of its workers, and closes the workers. With `wait`, every thread has
/// ended on return; otherwise DeviceInfo::threads takes over the threads inside a driver.
void run_frame(const std::shared_ptr<Frame>& frame, bool wait);

}  // namespace sundog
