// A thread that runs tasks in order. The waiting tasks are bounded in number and in bytes.
#pragma once
#include <fmt/format.h>

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>

namespace sundog {

class WorkQueue {
 public:
  WorkQueue() : thread_([this] { run(); }) {}
  /// Drops waiting tasks; waits for the running one.
  ~WorkQueue() { stop(); }
  WorkQueue(const WorkQueue&) = delete;
  WorkQueue& operator=(const WorkQueue&) = delete;

  /// Returns false if too much is waiting or the queue has stopped. `bytes`: memory that the task holds.
  /// Tasks handle their own errors; an exception that escapes (out of memory) ends only that task.
  bool post(std::function<void()> task, std::size_t bytes = 0) {
    {
      const std::lock_guard lock(mutex_);
      if (stopped_ || tasks_.size() >= most_waiting || bytes_ + bytes > most_bytes) return false;
      tasks_.push_back({std::move(task), bytes});
      bytes_ += bytes;
    }
    changed_.notify_one();
    return true;
  }

  void stop() {
    {
      const std::lock_guard lock(mutex_);
      stopped_ = true;
      tasks_.clear();
      bytes_ = 0;
    }
    changed_.notify_one();
    if (thread_.joinable()) thread_.join();
  }

 private:
  struct Task {
    std::function<void()> act;
    std::size_t bytes = 0;
  };
  static constexpr std::size_t most_waiting = 2000, most_bytes = std::size_t{64} << 20;

  void run() {
    for (;;) {
      Task task;
      {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [&] { return stopped_ || !tasks_.empty(); });
        if (stopped_) return;
        task = std::move(tasks_.front());
        tasks_.pop_front();
        bytes_ -= task.bytes;
      }
      try {
        task.act();
      } catch (const std::exception& error) {
        fmt::print(stderr, "sundog: serve: {}\n", error.what());
      }
    }
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Task> tasks_;
  std::size_t bytes_ = 0;  // held by waiting tasks
  bool stopped_ = false;
  std::thread thread_;  // last, because it uses all other members
};

}  // namespace sundog
