#include "scene/load.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/error.h"
#include "scene/animate.h"
#include "scene/json/override.h"
#include "scene/json/parse.h"
#include "scene/model.h"
#include "scene/model_scene.h"
#include "scene/read/scene_reader.h"

namespace sundog {
namespace fs = std::filesystem;
using nlohmann::json;

namespace {

void apply_overrides(json& document, const fs::path& file, const std::vector<std::string>& overrides) {
  for (const std::string& setting : overrides) apply_override(document, setting, file);
}

/// Width over height of a document's image; 0 where it gives none (reading it says what is wrong).
double aspect_of(const json& document) {
  const auto size = [&](const char* pointer) {
    const json::json_pointer place(pointer);
    return document.contains(place) && document[place].is_number() ? document[place].get<double>() : 0;
  };
  const double height = size("/image/height");
  return height > 0 ? std::max(size("/image/width"), 0.0) / height : 0;
}

/// The document made up around a model. Its camera fits the image that the overrides ask for, and its ground
/// the camera that they ask for.
json make_scene(const fs::path& file, const Model& model, const std::vector<std::string>& overrides) {
  json document = make_model_scene(file, model);
  json changed = document;
  apply_overrides(changed, file, overrides);
  const double aspect = aspect_of(changed);
  if (aspect > 0 && aspect != aspect_of(document)) document = make_model_scene(file, model, aspect);
  const json::json_pointer height("/camera/position/1");
  if (changed.contains(height) && changed[height].is_number())
    take_ground_above(document, changed[height].get<double>());
  return document;
}

/// Says which setting had a part in a value, or which track of which frame.
std::string changed_by(const std::string& place, const json& document,
                       const std::vector<std::string>& overrides, const LoadOptions& options) {
  if (options.frame)
    if (const std::string track = track_of(document, place); !track.empty())
      return fmt::format(" (in frame {}, moved by {})", *options.frame, track);
  for (const std::string& setting : overrides)
    if (concerns(setting, place)) return fmt::format(" (changed by the setting {})", setting);
  return "";
}

}  // namespace

/// A file's document before any frame of it, with the model that it was made up around.
struct SceneSource {
  fs::path file;
  json document;
  std::optional<Model> model = std::nullopt;

  static SceneSource open(const fs::path& path, const std::vector<std::string>& overrides,
                          const LoadOptions& options);
  SceneDescription read(const std::vector<std::string>& overrides, const LoadOptions& options) &&;
};

SceneSource SceneSource::open(const fs::path& path, const std::vector<std::string>& overrides,
                              const LoadOptions& options) {
  SceneSource source{path, {}};
  if (is_standard_input(path) && options.standard_input) {
    source.file = scene_file_name(path);
    source.document = parse_json(options.standard_input(), source.file);
  } else {
    require_readable(path, path, "");
    if (is_model_file(path)) {
      source.model = load_model(path, {.outside_files = options.outside_files});
      source.document = make_scene(path, *source.model, overrides);
    } else if (path.extension() == ".json") {
      source.document = read_json_file(path, options.faults);
    } else {
      throw SceneError(
          path.string(), "",
          "wanted a scene (.json) or a model (.gltf, .glb, .obj, .ply, .stl, .nff, each also .gz), found "
          "another extension");
    }
  }
  apply_overrides(source.document, source.file, overrides);
  return source;
}

SceneDescription SceneSource::read(const std::vector<std::string>& overrides, const LoadOptions& options) && {
  std::vector<std::string> warnings;
  const JsonContext context{.file = file,
                            .native_code = options.native_code,
                            .warnings = &warnings,
                            .outside_files = options.outside_files};
  if (options.frame) apply_animation(document, *options.frame, context);
  try {
    SceneDescription scene = read_scene(JsonValue(document, context), std::move(model));
    scene.warnings.insert(scene.warnings.end(), warnings.begin(), warnings.end());
    return scene;
  } catch (const SceneError& error) {
    // The place is in the file as overrides and tracks changed it.
    if (error.file != file.string()) throw;
    const std::string by = changed_by(error.place, document, overrides, options);
    if (by.empty()) throw;
    throw SceneError(error.file, error.place, error.reason + by);
  }
}

SceneFrames::SceneFrames(const fs::path& path, std::vector<std::string> overrides, LoadOptions options)
    : source_(std::make_unique<const SceneSource>(SceneSource::open(path, overrides, options))),
      overrides_(std::move(overrides)),
      options_(std::move(options)) {}

SceneFrames::~SceneFrames() = default;

SceneDescription SceneFrames::read(double frame) const {
  LoadOptions options = options_;
  options.frame = frame;
  return SceneSource(*source_).read(overrides_, options);
}

bool is_standard_input(const fs::path& path) { return path == "-" || path == "/dev/stdin"; }

std::string scene_file_name(const fs::path& path) {
  return is_standard_input(path) ? "standard input" : path.string();
}

SceneDescription load_scene(const fs::path& path, const std::vector<std::string>& overrides,
                            const LoadOptions& options) {
  return SceneSource::open(path, overrides, options).read(overrides, options);
}

}  // namespace sundog
