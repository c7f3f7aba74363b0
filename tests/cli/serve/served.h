// `sundog serve` with a small scene, for a test.
#pragma once
#include <string>

#include "background_program.h"
#include "temporary_folder.h"

inline constexpr const char* viewer_scene = R"({
  "camera": {"position": [2.2, 1.4, 2.6], "target": [0, 0, 0], "fov": 50},
  "image": {"width": 96, "height": 96, "background": [0.2, 0.3, 0.5]},
  "render": {"max_depth": 3},
  "lights": [{"type": "ambient"}, {"type": "point", "position": [3, 4, 3]}],
  "materials": {"red": {"color": [0.8, 0.2, 0.1]}, "floor": {"color": [0.7, 0.7, 0.7]}},
  "objects": [
    {"type": "formula", "name": "blob", "material": "red", "parameters": {"size": {"value": 1, "min": 0.2, "max": 1.4}},
     "distance": "length(p) - size"},
    {"type": "plane", "name": "ground", "point": [0, -1.2, 0], "material": "floor"}
  ]
})";

/// A server in a folder of its own with "scene.json" and "other.json", and its address.
struct Served {
  explicit Served(const char* text = viewer_scene) : served_text(text) {}
  const char* served_text;
  TemporaryFolder folder;
  std::string scene = folder.write("scene.json", served_text).string();
  std::string other = folder.write("sub/other.json", viewer_scene).string();
  BackgroundProgram program{{SUNDOG_BINARY, "serve", "scene.json"}, folder.path()};
  std::string url = program.line_with("http://");
  int port = std::stoi(url.substr(url.find(':', 7) + 1));
  std::string token = url.substr(url.find("token=") + 6);
  std::string with_token() const { return "X-Sundog-Token: " + token + "\r\n"; }
};
