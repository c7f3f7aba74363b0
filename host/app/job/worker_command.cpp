// `sundog worker DESCRIPTOR NAME`: is the device worker of its parent process (--isolate). Not for users.
#include <signal.h>
#include <unistd.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "app/job/remote_devices.h"
#include "app/options/command.h"
#include "app/options/devices.h"
#include "app/process/interrupt.h"
#include "base/arguments.h"
#include "base/error.h"
#include "render/remote/hang_watch.h"
#include "render/remote/silence.h"

namespace sundog {

namespace {

int work_on_device(int descriptor) {
  if (descriptor < 3) throw UsageError("worker is not a command for people: --isolate starts it");
  // Ctrl-C and a hang-up reach all processes of a terminal; the process that renders the frame decides.
  hold_back({SIGINT, SIGHUP});
  SocketChannel channel(descriptor);
  Orders orders(channel, [] { ::_exit(exit_failure); });
  const auto on_hang = [&](const std::string& what) {
    channel.send({Message::failed, {{"what", what}}, {}});
    ::_exit(exit_device);  // only the driver's thread could clean up
  };
  const auto beat = [&, since = Stopwatch()]() mutable {
    if (since.seconds() < beat_seconds) return;
    since = Stopwatch();
    try {
      channel.send({Message::alive, {}, {}});
    } catch (const ChannelClosed&) {  // `orders` handles it
    }
  };
  KeptOpen kept;  // for all frames of an animation
  HangWatch watch(on_hang, beat);
  follow_orders(
      channel, orders,
      [&](const nlohmann::json& settings) {
        watch.look_at({});  // releases the device of the previous frame
        OpenedWorker opened = open_worker(settings, settings.at("frame").is_number() ? &kept : nullptr);
        watch.look_at(opened);
        return opened;
      },
      list_devices);
  return exit_done;
}

struct WorkerOptions {
  int descriptor = -1;
  std::string name;
};

}  // namespace

void add_worker(Arguments& root, Command& chosen) {
  Arguments* app = root.add_subcommand("worker", "Serve a device to the process that started this")->hidden();
  const auto options = std::make_shared<WorkerOptions>();
  app->add_option("DESCRIPTOR", options->descriptor, "the socket to that process");
  app->add_option("NAME", options->name, "for lists of processes");
  app->callback([options, &chosen] {
    chosen = {.run = [options] { return work_on_device(options->descriptor); }, .in_first_thread = true};
  });
}

}  // namespace sundog
