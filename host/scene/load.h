// The entry point of the scene layer: reads any supported file to a SceneDescription.
#pragma once
#include <array>
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "models/model.h"
#include "scene/description.h"

namespace sundog {

class Faults;

/// An error at a place that one of the user's settings has changed, or has not.
struct SettingError : SceneError {
  using SceneError::SceneError;
};

struct LoadOptions {
  std::optional<double> frame = std::nullopt;  // animation frame; none: the scene as written
  bool native_code = false;                    // allow OpenCL C in the scene: only if the user trusts it
  bool outside_files = false;                  // scene and models may name files outside their folders
  std::array<int, 2> size{};                   // image size for read_scene_document(); 0: as in the file
  std::function<const std::string&()> standard_input{};  // text of the scene "-"; empty: "-" is a file
  std::shared_ptr<Faults> faults{};                      // when reading scene files
};

/// Whether the path is "-" or /dev/stdin.
bool is_standard_input(const std::filesystem::path& path);

/// The scene's name in errors: "standard input", or the path.
std::string scene_file_name(const std::filesystem::path& path);

/// Loads sundog's .json ("-": from the standard input, files that it names beside the current folder), or
/// a model file as a scene by itself: a camera that frames the bounds,
/// lights and a grey material are made up where the file has none. `overrides` are "JSON_POINTER=VALUE"
/// settings, applied in turn before the scene is checked (for a model file they apply to the scene that is
/// made of it). Throws SceneError{file, place, what}, SettingError where an override had a part in it, and
/// UsageError for an override that is not of that form.
SceneDescription load_scene(const std::filesystem::path& path, const std::vector<std::string>& overrides = {},
                            const LoadOptions& options = {});

/// The document that load_scene() reads: a scene file's, or one generated around a model. Throws SceneError.
nlohmann::json read_scene_document(const std::filesystem::path& path, const LoadOptions& options = {});

/// Reads the scene of a document. `file` (which need not exist) names it in messages, and file names are
/// relative to its folder. `made` are additional meshes. Throws SceneError.
SceneDescription load_scene_document(const nlohmann::json& document, const std::filesystem::path& file,
                                     const LoadOptions& options = {}, const NamedMeshes& made = {});

/// The part of a frame for which tracks and animations are blurred, and the number of times at which the
/// scene is seen meanwhile.
struct Shutter {
  double open = 0;
  int steps = 16;
};

/// A scene file whose frames are read one after the other: the file itself is read once, and so is what
/// frames have in common.
class SceneFrames {
 public:
  /// As load_scene(), whose errors it throws. `options.frame` does not count.
  SceneFrames(const std::filesystem::path& path, std::vector<std::string> overrides, LoadOptions options);
  ~SceneFrames();

  /// The scene at that frame of its animation; without one, as it is written.
  std::shared_ptr<const SceneDescription> read(std::optional<double> frame);
  /// As the document's camera says.
  Shutter shutter() const;
  /// Throws what reading one of these frames would throw, but for files that their predecessors do not name
  /// and meshes that they do not generate. Returns the first scene.
  std::shared_ptr<const SceneDescription> check(const std::vector<int>& frames);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace sundog
