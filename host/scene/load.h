// The entry point of the scene layer: reads any supported file into a SceneDescription.
#pragma once
#include <array>
#include <filesystem>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/environment.h"
#include "base/error.h"
#include "models/model.h"
#include "scene/description.h"

namespace sundog {

/// An error caused by a setting, or at a place that a setting changed.
struct SettingError : SceneError {
  using SceneError::SceneError;
};

struct LoadOptions {
  std::optional<double> frame = std::nullopt;  // animation frame; none: the scene as written
  bool native_code = false;                    // allow OpenCL C in the scene; only if the user trusts it
  bool outside_files = false;                  // scene and models may name files outside their folders
  std::array<int, 2> size{};                   // image size for read_scene_document(); 0: as in the file
  EnvironmentPtr environment{};                // has the standard input, and faults of reading
};

/// Whether the path is "-" or /dev/stdin.
bool is_standard_input(const std::filesystem::path& path);

/// The scene's name in errors: "standard input", or the path.
std::string scene_file_name(const std::filesystem::path& path);

/// Loads a .json scene ("-": standard input; its file names are relative to the current folder), or a model
/// file, for which a camera that frames its bounds, lights and a grey material are generated if missing.
/// `overrides` are "JSON_POINTER=VALUE" settings, applied in turn before the scene is checked (for a model
/// file: to the generated scene). Throws SceneError{file, place, what}, SettingError if an override is
/// involved, and UsageError for a malformed override.
SceneDescription load_scene(const std::filesystem::path& path, const std::vector<std::string>& overrides = {},
                            const LoadOptions& options = {});

/// The document that load_scene() reads: a scene file's, or one generated around a model. Throws SceneError.
nlohmann::json read_scene_document(const std::filesystem::path& path, const LoadOptions& options = {});

/// Reads the scene of a document. `file` (which need not exist) names it in messages; file names are relative
/// to its folder. `made` are additional meshes. Throws SceneError.
SceneDescription load_scene_document(const nlohmann::json& document, const std::filesystem::path& file,
                                     const LoadOptions& options = {}, const NamedMeshes& made = {});

/// The shutter: the share of a frame's time for which it is open, and the number of times at which the scene
/// is sampled meanwhile.
struct Shutter {
  double open = 0;
  int steps = 16;
};

/// A scene file whose frames are read one after another. Reads the file, and everything that its frames
/// share, only once.
class SceneFrames {
 public:
  /// Like load_scene(), with its errors. `options.frame` is ignored.
  SceneFrames(const std::filesystem::path& path, std::vector<std::string> overrides, LoadOptions options);
  ~SceneFrames();

  /// The scene at this frame of its animation; without a frame, the scene as written.
  std::shared_ptr<const SceneDescription> read(std::optional<double> frame);
  /// The shutter of the document's camera.
  Shutter shutter() const;
  /// Checks these frames: throws the first error that reading them would, but reads no model and generates no
  /// mesh for a place that had one in an earlier frame, and skips field surveys and displacement. Returns the
  /// first scene.
  std::shared_ptr<const SceneDescription> check(const std::vector<int>& frames);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace sundog
