// The peer of a RemoteWorker: takes orders from a channel and executes them on a device.
#pragma once
#include <condition_variable>
#include <deque>
#include <functional>
#include <thread>

#include "render/frame/device_worker.h"
#include "render/remote/channel.h"

namespace sundog {

/// The cores on which this process may run; 0: unknown.
unsigned usable_cores();

/// Reads a channel in its own thread, so that a stop order or the peer's end is noticed while a driver is
/// working.
class Orders {
 public:
  /// The thread calls `on_closed` if the peer is gone or sends malformed data.
  Orders(Channel& channel, std::function<void()> on_closed);
  ~Orders();
  Orders(const Orders&) = delete;
  Orders& operator=(const Orders&) = delete;

  /// The next list, open or render order; nothing after close.
  std::optional<Message> next();
  /// Set when the current job is no longer wanted.
  const std::atomic<bool>& unwanted() const { return unwanted_; }

 private:
  void read();
  void take(Message message);

  Channel& channel_;
  std::function<void()> on_closed_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Message> waiting_;
  std::uint64_t stopped_job_ = 0, current_job_ = 0;
  std::atomic<bool> unwanted_{false}, leaving_{false};
  bool closed_ = false;
  std::thread thread_;
};

/// A device prepared for a frame.
struct OpenedWorker {
  std::shared_ptr<const void> kept;  // owns everything that the worker refers to
  std::shared_ptr<DeviceWorker> worker;
  std::uint64_t scene = 0;  // hash_scene() of its scene
};

/// Executes orders, frame after frame, until the channel is closed. `make` creates the worker for an open
/// order (loading its scene); its exceptions and the worker's are sent as the reply. `list` lists the
/// devices.
void follow_orders(Channel& channel, Orders& orders,
                   const std::function<OpenedWorker(const nlohmann::json& settings)>& make,
                   const std::function<std::vector<DeviceInfo>()>& list);

}  // namespace sundog
