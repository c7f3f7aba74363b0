// Joins abandoned threads that have ended, and waits for the others within a limit.
#include "base/driver_threads.h"

#include <optional>

namespace sundog {
namespace {

bool has_ended(const DriverThread& thread) {
  return thread.ended.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

/// Joins threads that have ended, because an unjoined thread keeps its stack's address space.
void join_ended(std::vector<DriverThread>& threads) {
  std::erase_if(threads, [](DriverThread& left) {
    if (!has_ended(left)) return false;
    left.thread.join();
    return true;
  });
}

}  // namespace

void DriverThreads::wait() {
  const auto limit = std::chrono::steady_clock::now() + patience_;
  const auto take_last = [this]() -> std::optional<DriverThread> {
    const std::lock_guard lock(mutex_);
    if (threads_.empty()) return std::nullopt;
    DriverThread last = std::move(threads_.back());
    threads_.pop_back();
    return last;
  };
  // One at a time: a thread that ends may leave its own compiler's thread here.
  while (std::optional<DriverThread> left = take_last()) {
    const bool own = left->thread.get_id() == std::this_thread::get_id();  // it dropped the last reference
    if (!own && left->ended.wait_until(limit) == std::future_status::ready)
      left->thread.join();
    else
      left->thread.detach();
  }
}

void DriverThreads::take(DriverThread thread) {
  const std::lock_guard lock(mutex_);
  join_ended(threads_);
  threads_.push_back(std::move(thread));
}

unsigned DriverThreads::count() {
  const std::lock_guard lock(mutex_);
  join_ended(threads_);
  return static_cast<unsigned>(threads_.size());
}

void leave_thread(const std::weak_ptr<DriverThreads>& to, DriverThread thread) {
  if (const auto owner = to.lock())
    owner->take(std::move(thread));
  else
    thread.thread.join();
}

}  // namespace sundog
