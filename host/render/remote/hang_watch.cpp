// Checks the worker's launch every 50 ms from a thread, and reports one that hangs.
#include "render/remote/hang_watch.h"

#include <fmt/format.h>

#include <chrono>

namespace sundog {

HangWatch::HangWatch(std::function<void(const std::string&)> on_hang, std::function<void()> always)
    : on_hang_(std::move(on_hang)), always_(std::move(always)), thread_([this] { watch(); }) {}

HangWatch::~HangWatch() {
  leaving_ = true;
  thread_.join();
}

void HangWatch::look_at(const OpenedWorker& opened) {
  const std::lock_guard lock(mutex_);
  opened_ = opened;
}

void HangWatch::watch() {
  for (; !leaving_; std::this_thread::sleep_for(std::chrono::milliseconds(50))) {
    if (always_) always_();
    const std::lock_guard lock(mutex_);
    const double seconds = opened_.worker ? opened_.worker->overdue() : 0;
    if (seconds <= 0) continue;
    on_hang_(fmt::format("{}: a launch has not come back for {:.0f} s: the driver hangs",
                         opened_.worker->info().label(), seconds));
    return;
  }
}

}  // namespace sundog
