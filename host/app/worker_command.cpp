// `sundog worker DESCRIPTOR NAME`: serves one device to the process that started it (--isolate). Not for
// people.
#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <mutex>
#include <thread>

#include "app/commands.h"
#include "app/remote_devices.h"
#include "base/error.h"

namespace sundog {
namespace {

/// Ends the process when a launch passes its limit: only the driver's thread could end it in good order.
class HangWatch {
 public:
  explicit HangWatch(Channel& channel) : channel_(channel), thread_([this] { watch(); }) {}
  ~HangWatch() {
    leaving_ = true;
    thread_.join();
  }
  void look_at(const OpenedServer& opened) {
    const std::lock_guard lock(mutex_);
    opened_ = opened;
  }

 private:
  void watch() {
    for (; !leaving_; std::this_thread::sleep_for(std::chrono::milliseconds(50))) {
      const std::lock_guard lock(mutex_);
      const double seconds = opened_.server ? opened_.server->overdue() : 0;
      if (seconds <= 0) continue;
      const std::string what = fmt::format("{}: a launch has not come back for {:.0f} s: the driver hangs",
                                           opened_.server->info().label(), seconds);
      channel_.send({Message::failed, {{"what", what}}, {}});
      ::_exit(exit_device);
    }
  }

  Channel& channel_;
  std::mutex mutex_;
  OpenedServer opened_;
  std::atomic<bool> leaving_{false};
  std::thread thread_;
};

}  // namespace

int worker_command(int argc, const char* const* argv) {
  const int descriptor = argc > 2 ? std::atoi(argv[2]) : -1;
  if (descriptor < 3) throw UsageError("worker is not a command for people: --isolate starts it");
  ::signal(SIGINT,
           SIG_IGN);  // Ctrl-C goes to all of a terminal's processes; the one that has the frame decides
  SocketChannel channel(descriptor);
  Orders orders(channel, [] { ::_exit(exit_failure); });
  HangWatch watch(channel);
  serve_orders(channel, orders, [&](const nlohmann::json& settings) {
    OpenedServer opened = open_server(settings);
    watch.look_at(opened);
    return opened;
  });
  return exit_done;
}

}  // namespace sundog
