// Messages between the process that has the frame and those that have devices: a worker process on the other
// end of a socket, or another machine's process.
#pragma once
#include <cstdint>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "base/error.h"

namespace sundog {

/// The other end is gone.
struct ChannelClosed : DeviceError {
  using DeviceError::DeviceError;
};

struct Message {
  enum Kind : std::uint32_t {
    list,     // to a worker: which devices are there?
    devices,  // back: {devices, cores}
    open,     // to a worker: make a device ready for a frame
    ready,    // back: {times, scene}
    render,   // to a worker: {job, tile...}, data: the pixels of a pass and their earlier samples
    stop,     // to a worker: {job}: enough of that tile
    tile,     // back: {tile, counts, figures}, data: its pixels
    failed,   // back, at any time: {what, status, build, log}; {closed}: nothing else will come; {hangs}:
              // never
    close,    // to a worker: the end
    alive,    // both ways, again and again (silence.h); no receive() gives it out
    leave,    // to another rank: the job is over
    left,     // back: it is ready for the end
  };
  Kind kind = close;
  nlohmann::json values;
  std::string data;  // bytes that are no JSON
};

/// Message <-> bytes.
std::string pack(const Message& message);
/// Throws ChannelClosed for what is no message.
Message unpack(const std::string& bytes);

/// One end. Both functions may be called by several threads.
class Channel {
 public:
  virtual ~Channel() = default;
  /// Throws ChannelClosed.
  virtual void send(const Message& message) = 0;
  /// Waits so long at most; nothing when nothing came. Throws ChannelClosed.
  virtual std::optional<Message> receive(double seconds) = 0;
};

/// A connected stream socket, which is closed at the end.
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
  std::string arrived_;  // the beginning of a message, or several
};

}  // namespace sundog
