// The scene that the command line's tests render, and their folder.
#pragma once
#include <string>

#include "run_command.h"
#include "temporary_folder.h"

inline constexpr const char* small_scene = R"({
  "camera": {"position": [0, 1, 5], "target": [0, 0, 0], "fov": 40},
  "image": {"width": 32, "height": 24, "background": [0.2, 0.4, 0.8]},
  "lights": [{"type": "ambient"}, {"type": "point", "position": [-3, 5, 4]}],
  "materials": {
    "floor": {"color": [0.8, 0.8, 0.8]},
    "glass": {"type": "dielectric", "ior": 1.5}
  },
  "objects": [
    {"type": "plane", "point": [0, -1, 0], "material": "floor"},
    {"type": "sphere", "material": "glass"}
  ]
})";

/// A folder with the scene in it.
struct CliFolder : TemporaryFolder {
  std::string scene = write("scene.json", small_scene).string();
  std::string file(std::string_view name) const { return (*this / name).string(); }
};

/// True when the text is one line that starts with "sundog: ".
inline bool is_one_error_line(const std::string& text) {
  return text.starts_with("sundog: ") && text.find('\n') == text.size() - 1;
}
