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

/// Width over height of a document's image; 0 if missing or invalid (reading reports the error).
double aspect_of(const json& document) {
  const auto size = [&](const char* pointer) {
    const json::json_pointer place(pointer);
    return document.contains(place) && document[place].is_number() ? document[place].get<double>() : 0;
  };
  const double height = size("/image/height");
  return height > 0 ? std::max(size("/image/width"), 0.0) / height : 0;
}

/// The document generated around a model. Its camera fits the overridden image size, and its ground the
/// overridden camera.
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

SceneDescription read_with_overrides(json document, const fs::path& file,
                                     const std::vector<std::string>& overrides, const LoadOptions& options,
                                     std::optional<Model> model) {
  apply_overrides(document, file, overrides);
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
    // The place is in the file as the overrides changed it: say which of them had a part in it.
    if (error.file == file.string())
      for (const std::string& setting : overrides)
        if (concerns(setting, error.place))
          throw SceneError(error.file, error.place,
                           fmt::format("{} (changed by the setting {})", error.reason, setting));
    throw;
  }
}

}  // namespace

bool is_standard_input(const fs::path& path) { return path == "-" || path == "/dev/stdin"; }

std::string scene_file_name(const fs::path& path) {
  return is_standard_input(path) ? "standard input" : path.string();
}

SceneDescription load_scene(const fs::path& path, const std::vector<std::string>& overrides,
                            const LoadOptions& options) {
  if (is_standard_input(path) && options.standard_input) {
    const fs::path name = scene_file_name(path);
    return read_with_overrides(parse_json(options.standard_input(), name), name, overrides, options,
                               std::nullopt);
  }
  require_readable(path, path, "");
  if (is_model_file(path)) {
    Model model = load_model(path, {.outside_files = options.outside_files});
    json document = make_scene(path, model, overrides);
    return read_with_overrides(std::move(document), path, overrides, options, std::move(model));
  }
  if (path.extension() != ".json")
    throw SceneError(
        path.string(), "",
        "wanted a scene (.json) or a model (.gltf, .glb, .obj, .ply, .stl, .nff, each also .gz), found "
        "another extension");
  return read_with_overrides(read_json_file(path, options.faults), path, overrides, options, std::nullopt);
}

}  // namespace sundog
