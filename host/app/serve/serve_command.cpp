// `sundog serve`: serves the viewer as a page to a browser on this machine, or at the end of an ssh tunnel.
// Prints one URL, and serves until interrupted.

#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <memory>
#include <thread>

#include "app/options/command.h"
#include "app/options/devices.h"
#include "app/options/option_helpers.h"
#include "app/options/option_values.h"
#include "app/process/exit_status.h"
#include "app/process/interrupt.h"
#include "app/process/standard_streams.h"
#include "app/process/warnings.h"
#include "app/serve/studio.h"
#include "base/error.h"
#include "base/file.h"

namespace sundog {
namespace {

namespace fs = std::filesystem;

struct ServeOptions {
  std::string scene, port, token_file;
  std::vector<std::string> devices, hosts;
  std::vector<PublicName> names;  // parsed `hosts`
};

/// The scene that the viewer opens if the command names none.
constexpr const char* first_scene = R"({
  "camera": {"position": [1.5, 1.05, -2.6], "target": [0, -0.02, 0], "fov": 44},
  "image": {"width": 640, "height": 640, "background": {"bottom": [0.01, 0.012, 0.02], "top": [0.11, 0.14, 0.2]}},
  "render": {"max_depth": 3},
  "lights": [
    {"type": "ambient", "intensity": 0.75},
    {"type": "directional", "direction": [-0.9, -1, 0.75], "color": [1, 0.93, 0.82], "intensity": 1.1},
    {"type": "point", "position": [-4, 1, -2], "color": [0.55, 0.7, 1], "intensity": 0.35}
  ],
  "materials": {
    "surface": {"color": [1, 1, 1], "ambient": 0.3, "diffuse": 0.9, "specular": {"coefficient": 0.25, "exponent": 40}}
  },
  "objects": [
    {"type": "fractal", "formula": "mandelbulb", "material": "surface", "detail": 0.75, "occlusion": 0.25,
     "coloring": {"by": "point", "scale": 1.15, "offset": 0.05,
       "palette": [[0.62, 0.16, 0.05], [0.85, 0.5, 0.16], [0.9, 0.83, 0.6], [0.16, 0.32, 0.46], [0.07, 0.1, 0.22]]}}
  ]
})";

SceneDocument first_document(const ServeOptions& options) {
  SceneDocument document;
  if (options.scene.empty())
    document.replace(nlohmann::json::parse(first_scene), working_folder() / "untitled.json");
  else
    document.open(working_folder() / options.scene);
  return document;
}

/// Stops the server at a signal, so that its temporary files are removed.
class EndsOnSignal {
 public:
  EndsOnSignal(const StopOnSignal& signal, WebServer& server)
      : thread_([&signal, &server](const std::stop_token& over) {
          while (!over.stop_requested() && !signal.flag()) std::this_thread::sleep_for(look_again);
          server.stop();
        }) {}

 private:
  static constexpr std::chrono::milliseconds look_again{100};
  std::jthread thread_;
};

int serve(const ServeOptions& options) {
  if (options.port.empty() || options.token_file.empty()) require_standard_output();  // it gets the address
  const StopOnSignal signal;
  SceneDocument document = first_document(options);
  print_warnings(document.scene()->warnings);
  StudioSetup setup{working_folder(), list_devices(), {}};
  setup.picked = pick_devices(setup.devices, options.devices);
  WebServer server(options.port.empty() ? 0 : parse_number("--port", options.port, 0, 65535), {});
  const std::string token = options.token_file.empty() ? random_token() : kept_token(options.token_file);
  const Gate gate = make_gate(server.port(), token, options.names);
  Studio studio(server, std::move(setup), std::move(document));
  fmt::print("http://127.0.0.1:{}/#token={}\n", server.port(), gate.token);
  flush_standard_output();  // throws if nobody can read the address
  const EndsOnSignal ends(signal, server);
  server.run(gate, studio.handlers());
  return exit_done;
}

}  // namespace

void add_serve(Arguments& root, Command& chosen) {
  const auto options = std::make_shared<ServeOptions>();
  Arguments* app = root.add_subcommand("serve", "Show a scene in a browser, to explore and change it live");
  value(app, "SCENE", "FILE", options->scene, "a .json scene or a model; without it a Mandelbulb");
  value(app, "--port", "N", options->port, "port on the loopback address (default: any that is free)");
  values(app, "--device", "SPEC", options->devices, device_help);
  values(app, "--host", "NAME", options->hosts,
         "a further name by which browsers reach this server, as through a tunnel or a proxy with https; "
         "NAME:PORT where their address line has a port");
  value(app, "--token-file", "FILE", options->token_file,
        "keep the token in this file, so that open pages come back when the server is started anew");
  app->callback([options, &chosen] {
    for (const std::string& host : options->hosts) options->names.push_back(parse_public_name(host));
    chosen = {.run = [options] { return serve(*options); }, .stops_on_signal = true};
  });
}

}  // namespace sundog
