// `sundog worker DESCRIPTOR NAME`: serves one device to the process that started it (--isolate). Not for
// people.
#include <signal.h>
#include <unistd.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "app/job/remote_devices.h"
#include "app/options/commands.h"
#include "app/process/environment.h"
#include "app/process/interrupt.h"
#include "base/error.h"
#include "render/remote/hang_watch.h"
#include "render/remote/silence.h"

namespace sundog {

int worker_command(int argc, const char* const* argv) {
  const int descriptor = argc > 2 ? std::atoi(argv[2]) : -1;
  if (descriptor < 3) throw UsageError("worker is not a command for people: --isolate starts it");
  // Ctrl-C and a hang-up go to all of a terminal's processes; the one that has the frame decides.
  hold_back({SIGINT, SIGHUP});
  SocketChannel channel(descriptor);
  Orders orders(channel, [] { ::_exit(exit_failure); });
  const auto on_hang = [&](const std::string& what) {
    channel.send({Message::failed, {{"what", what}}, {}});
    ::_exit(exit_device);  // only the driver's thread could end it in good order
  };
  const auto beat = [&, since = Stopwatch()]() mutable {
    if (since.seconds() < beat_seconds) return;
    since = Stopwatch();
    try {
      channel.send({Message::alive, {}, {}});
    } catch (const ChannelClosed&) {  // which `orders` sees as well
    }
  };
  KeptOpen kept;  // from frame to frame of an animation
  HangWatch watch(on_hang, beat);
  serve_orders(
      channel, orders,
      [&](const nlohmann::json& settings) {
        watch.look_at({});  // which held the device of the frame before
        OpenedServer opened = open_server(settings, settings.at("frame").is_number() ? &kept : nullptr);
        watch.look_at(opened);
        return opened;
      },
      list_devices);
  return exit_done;
}

}  // namespace sundog
