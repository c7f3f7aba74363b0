// The scene that the command line's tests render, and their folder.
#pragma once
#include <filesystem>
#include <string>

#include "base/file.h"
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

/// small_scene's camera and image, a plane alone: for tests that start without kernels, which compile in a
/// fifth less time.
inline constexpr const char* least_scene = R"({
  "camera": {"position": [0, 1, 5], "target": [0, 0, 0], "fov": 40},
  "image": {"width": 32, "height": 24, "background": [0.2, 0.4, 0.8]},
  "lights": [{"type": "ambient"}],
  "materials": {"floor": {"color": [0.8, 0.8, 0.8]}},
  "objects": [{"type": "plane", "point": [0, -1, 0], "material": "floor"}]
})";

/// A folder with the scene in it.
struct CliFolder : TemporaryFolder {
  std::string scene = write("scene.json", small_scene).string();
  std::string file(std::string_view name) const { return (*this / name).string(); }
};

/// Copies the kernels to the folder, for SUNDOG_KERNEL_DIR. All but those of Whitted's frames become empty:
/// `sundog check` compiles every kernel anew, which takes ten seconds, and draws with that one.
inline void copy_frame_kernels(const std::filesystem::path& folder) {
  namespace fs = std::filesystem;
  fs::copy(SUNDOG_SOURCE_DIR "/kernels", folder,
           fs::copy_options::recursive | fs::copy_options::overwrite_existing);
  for (const auto& file : fs::directory_iterator(folder / "entry"))
    if (file.path().filename() != "render_whitted.cl")
      sundog::write_file(file.path(), "__kernel void nothing(void) {}\n");
}

/// True when the text is one line that starts with "sundog: ".
inline bool is_one_error_line(const std::string& text) {
  return text.starts_with("sundog: ") && text.find('\n') == text.size() - 1;
}
