// Keeps threads that are inside a driver's compiler or launch when their result is no longer needed. A driver
// cannot be interrupted, so the owner of its devices takes over such threads and joins them last.
#pragma once
#include <chrono>
#include <future>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

namespace sundog {

/// A thread and a future that allows a timed wait for its end.
struct DriverThread {
  std::thread thread;
  std::shared_future<void> ended;
};

/// Runs f() in a new thread.
template <class F>
DriverThread start_thread(F f) {
  std::promise<void> end;
  std::shared_future<void> ended = end.get_future().share();
  return {std::thread([f = std::move(f), end = std::move(end)]() mutable {
            f();
            end.set_value_at_thread_exit();
          }),
          std::move(ended)};
}

/// Takes over abandoned threads and joins them. Thread-safe.
class DriverThreads {
 public:
  /// A thread still in a driver after `patience` counts as hung. The longest compilation seen took 40 s
  /// (llvmpipe).
  explicit DriverThreads(std::chrono::milliseconds patience = std::chrono::minutes(1))
      : patience_(patience) {}
  ~DriverThreads() { wait(); }
  DriverThreads(const DriverThreads&) = delete;
  DriverThreads& operator=(const DriverThreads&) = delete;

  void take(DriverThread thread);
  /// Joins all threads, including any that arrive meanwhile; detaches threads that hang.
  void wait();
  /// Number of threads still running.
  unsigned count();

 private:
  const std::chrono::milliseconds patience_;
  std::mutex mutex_;
  std::vector<DriverThread> threads_;
};

/// Hands the thread to its owner; waits for its end if the owner is gone.
void leave_thread(const std::weak_ptr<DriverThreads>& to, DriverThread thread);

}  // namespace sundog
