// Watches a worker's launches from another thread, in a process that renders for another process.
#pragma once
#include <atomic>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

#include "render/remote/tile_worker.h"

namespace sundog {

class HangWatch {
 public:
  /// Starts the thread. It calls `on_hang` once, with a message, if a launch exceeds its limit, and `always`
  /// about twenty times per second.
  explicit HangWatch(std::function<void(const std::string&)> on_hang, std::function<void()> always = {});
  ~HangWatch();
  HangWatch(const HangWatch&) = delete;
  HangWatch& operator=(const HangWatch&) = delete;

  void look_at(const OpenedWorker& opened);

 private:
  void watch();

  std::function<void(const std::string&)> on_hang_;
  std::function<void()> always_;
  std::mutex mutex_;
  OpenedWorker opened_;
  std::atomic<bool> leaving_{false};
  std::thread thread_;
};

}  // namespace sundog
