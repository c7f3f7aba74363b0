// Messages between the process that owns the frame and processes that own devices: worker processes behind a
// socket, or processes on other machines.
#pragma once
#include <cstdint>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "base/error.h"

namespace sundog {

/// The peer is gone.
struct ChannelClosed : DeviceError {
  using DeviceError::DeviceError;
};

struct Message {
  enum Kind : std::uint32_t {
    list,     // to a worker: list the devices
    devices,  // reply: {devices, cores}
    open,     // to a worker: prepare a device for a frame
    ready,    // reply: {times, scene}
    render,   // to a worker: {job, tile...}, data: the pixels of a pass and their earlier samples
    stop,     // to a worker: {job}: stop rendering that tile
    tile,     // reply: {tile, counts, figures}, data: its pixels
    failed,   // at any time: {what, status, build, log}; {closed}: nothing else follows; {hangs}: the driver
              // hangs
    close,    // to a worker: end
    alive,    // both ways, periodically (silence.h); receive() filters it
    leave,    // to another rank: the job is over
    left,     // reply: ready for the end
  };
  Kind kind = close;
  nlohmann::json values;
  std::string data;  // binary payload
};

/// Serialisation.
std::string pack(const Message& message);
/// Throws ChannelClosed for malformed bytes.
Message unpack(const std::string& bytes);

/// One end of a connection. Both functions are thread-safe.
class Channel {
 public:
  virtual ~Channel() = default;
  /// Throws ChannelClosed.
  virtual void send(const Message& message) = 0;
  /// Waits for at most `seconds`; nothing on timeout. Throws ChannelClosed.
  virtual std::optional<Message> receive(double seconds) = 0;
};

/// A connected stream socket, closed on destruction.
class SocketChannel : public Channel {
 public:
  explicit SocketChannel(int socket) : socket_(socket) {}
  ~SocketChannel() override;
  void send(const Message& message) override;
  std::optional<Message> receive(double seconds) override;

 private:
  bool read_some();

  int socket_;
  std::mutex sending_, receiving_;
  std::string arrived_;  // a partial message, or several
};

}  // namespace sundog
