// Starts a worker process with a socket as file descriptor 3, detects its death or silence, and explains how
// it ended.
#include "render/remote/worker_process.h"

#include <fmt/format.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <optional>
#include <utility>

#include "base/environment.h"
#include "base/error.h"
#include "render/remote/silence.h"

namespace sundog {
namespace {

constexpr int worker_descriptor = 3;

class WorkerChannel : public Channel {
 public:
  WorkerChannel(int socket, std::unique_ptr<StartedProgram> process, std::string name, double limit)
      : limit_(limit),
        socket_(std::make_unique<SocketChannel>(socket)),
        process_(std::move(process)),
        name_(std::move(name)) {}
  ~WorkerChannel() override {
    socket_.reset();  // tells the process to end
    await_end(2);
    if (end_) return;
    process_->end();
    await_end(2);
  }
  void send(const Message& message) override {
    try {
      socket_->send(message);
    } catch (const ChannelClosed&) {
      throw_end();
    }
  }
  std::optional<Message> receive(double seconds) override {
    try {
      while (std::optional<Message> message = socket_->receive(seconds)) {
        silence_.heard();
        if (message->kind != Message::alive) return message;
      }
    } catch (const ChannelClosed&) {
      throw_end();
    }
    if (silence_.seconds() > limit_) throw_silent();
    return std::nullopt;
  }

 private:
  void await_end(double seconds) {
    if (!end_) end_ = wait_for_end(*process_, seconds);
  }
  [[noreturn]] void throw_end() {
    await_end(1);
    std::string how = "closed its channel";
    if (end_ && end_->signal > 0)
      how = fmt::format("was killed by signal {} ({})", end_->signal, ::strsignal(end_->signal));
    else if (end_)
      how = fmt::format("ended with status {}", end_->status);
    throw ChannelClosed(fmt::format("{}: its worker process {}", name_, how));
  }

  /// Kills a silent worker and throws: a stopped or hung process does not exit by itself.
  [[noreturn]] void throw_silent() {
    const double seconds = silence_.seconds();
    process_->end();
    await_end(2);
    throw ChannelClosed(fmt::format("{}: its worker process had not been heard of for {:.1f} s and was ended",
                                    name_, seconds));
  }

  Silence silence_;
  const double limit_;  // limit of silence in seconds
  std::unique_ptr<SocketChannel> socket_;
  std::unique_ptr<StartedProgram> process_;
  std::optional<ProgramEnd> end_;
  std::string name_;
};

std::unique_ptr<StartedProgram> spawn(const HostEnvironment& environment, int socket,
                                      const std::string& name) {
  if (!environment.start_program)
    throw DeviceError(fmt::format("{}: this program starts no worker processes", name));
  try {
    return environment.start_program({"worker", std::to_string(worker_descriptor), name},
                                     {{socket, worker_descriptor}});
  } catch (const IoError& error) {
    throw DeviceError(fmt::format("{}: no worker process: {}", name, error.what()));
  }
}

}  // namespace

std::unique_ptr<Channel> start_worker(const HostEnvironment& environment, const std::string& name) {
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
    throw DeviceError(fmt::format("{}: no socket for its worker process: {}", name, std::strerror(errno)));
  try {
    std::unique_ptr<StartedProgram> process = spawn(environment, ends[1], name);
    ::close(ends[1]);
    return std::make_unique<WorkerChannel>(ends[0], std::move(process), name, environment.silence_limit);
  } catch (const DeviceError&) {
    ::close(ends[0]);
    ::close(ends[1]);
    throw;
  }
}

}  // namespace sundog
