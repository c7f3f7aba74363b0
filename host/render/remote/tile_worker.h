// The other end of a RemoteServer: takes orders from a channel and has a device carry them out.
#pragma once
#include <condition_variable>
#include <deque>
#include <functional>
#include <thread>

#include "render/frame/tile_server.h"
#include "render/remote/channel.h"

namespace sundog {

/// The cores that this process may run on; 0: unknown.
unsigned usable_cores();

/// Reads a channel in a thread of its own, so that an order to stop, or the end of the other side, is noticed
/// while a driver is at work.
class Orders {
 public:
  /// `on_closed` is called by that thread when the other end is gone or hangs up.
  Orders(Channel& channel, std::function<void()> on_closed);
  ~Orders();
  Orders(const Orders&) = delete;
  Orders& operator=(const Orders&) = delete;

  /// The next list, open or render; nothing after close.
  std::optional<Message> next();
  /// Set while the job that next() gave last is no longer wanted.
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

/// A device made ready for a frame.
struct OpenedServer {
  std::shared_ptr<const void> kept;  // what the server refers to
  std::shared_ptr<TileServer> server;
  std::uint64_t scene = 0;  // hash_scene() of what it renders
};

/// Serves until told to close. `make` makes the server of an open order (loading its scene); what it throws,
/// and what the server throws, is sent as the answer.
/// `list` lists the devices.
void serve_orders(Channel& channel, Orders& orders,
                  const std::function<OpenedServer(const nlohmann::json& settings)>& make,
                  const std::function<std::vector<DeviceInfo>()>& list);

}  // namespace sundog
