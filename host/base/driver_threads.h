// Threads inside a driver's compiler or launch whose work is no longer needed. A driver cannot be
// interrupted, so the owner of its devices takes such threads over and joins them last.
#pragma once
#include <chrono>
#include <future>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

namespace sundog {

/// A thread, and how its end is waited for with a limit.
struct DriverThread {
  std::thread thread;
  std::shared_future<void> ended;
};

/// f() in a thread of its own.
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

/// Any thread may call it.
class DriverThreads {
 public:
  /// A thread that a driver has not let go of after `patience` hangs. The longest compilation seen took 40 s,
  /// on llvmpipe.
  explicit DriverThreads(std::chrono::milliseconds patience = std::chrono::minutes(1))
      : patience_(patience) {}
  ~DriverThreads() { wait(); }
  DriverThreads(const DriverThreads&) = delete;
  DriverThreads& operator=(const DriverThreads&) = delete;

  void take(DriverThread thread);
  /// For all that it has; those that hang are detached.
  void wait();
  /// How many have not ended.
  unsigned count();

 private:
  const std::chrono::milliseconds patience_;
  std::mutex mutex_;
  std::vector<DriverThread> threads_;
};

/// Hands the thread over; without anybody who takes it, waits for its end.
void leave_thread(const std::weak_ptr<DriverThreads>& to, DriverThread thread);

}  // namespace sundog
