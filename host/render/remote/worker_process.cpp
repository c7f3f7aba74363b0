#include "render/remote/worker_process.h"

#include <fmt/format.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <thread>

#include "base/environment.h"
#include "base/error.h"
#include "render/remote/silence.h"

namespace sundog {
namespace {

constexpr int worker_descriptor = 3;

class WorkerChannel : public Channel {
 public:
  WorkerChannel(int socket, pid_t process, std::string name, double limit)
      : limit_(limit),
        socket_(std::make_unique<SocketChannel>(socket)),
        process_(process),
        name_(std::move(name)) {}
  ~WorkerChannel() override {
    socket_.reset();  // which tells it to end
    wait_for_end(2);
    if (process_ > 0) ::kill(process_, SIGKILL);
    wait_for_end(2);
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
  void wait_for_end(double seconds) {
    for (double waited = 0; process_ > 0 && waited <= seconds; waited += 0.01) {
      if (::waitpid(process_, &status_, WNOHANG) == process_)
        process_ = 0;
      else
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  }
  [[noreturn]] void throw_end() {
    wait_for_end(1);
    std::string how = "closed its channel";
    if (process_ == 0 && WIFSIGNALED(status_))
      how = fmt::format("was killed by signal {} ({})", WTERMSIG(status_), ::strsignal(WTERMSIG(status_)));
    else if (process_ == 0)
      how = fmt::format("ended with status {}", WEXITSTATUS(status_));
    throw ChannelClosed(fmt::format("{}: its worker process {}", name_, how));
  }

  /// It is stopped, or hangs as a whole: it will not end by itself.
  [[noreturn]] void throw_silent() {
    const double seconds = silence_.seconds();
    ::kill(process_, SIGKILL);
    wait_for_end(2);
    throw ChannelClosed(fmt::format("{}: its worker process had not been heard of for {:.1f} s and was ended",
                                    name_, seconds));
  }

  Silence silence_;
  const double limit_;  // of its silence, in seconds
  std::unique_ptr<SocketChannel> socket_;
  pid_t process_;  // 0: ended, and waited for
  int status_ = 0;
  std::string name_;
};

pid_t spawn(const HostEnvironment& environment, int socket, const std::string& name) {
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
    const pid_t process = spawn(environment, ends[1], name);
    ::close(ends[1]);
    return std::make_unique<WorkerChannel>(ends[0], process, name, environment.silence_limit);
  } catch (const DeviceError&) {
    ::close(ends[0]);
    ::close(ends[1]);
    throw;
  }
}

}  // namespace sundog
