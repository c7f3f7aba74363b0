// See document.h. The parts that a viewer changes most, often sixty times a second, are read by themselves.
#include "scene/document.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "scene/json/parse.h"
#include "scene/json/value.h"
#include "scene/kinds.h"
#include "scene/model_scene.h"
#include "scene/read/parts.h"
#include "scene/read/scene_reader.h"

namespace sundog {
namespace fs = std::filesystem;
using nlohmann::json;

namespace {

constexpr std::array view_keys = {"camera", "image", "render", "lights"};

bool same_but_view(const json& before, const json& after) {
  if (!before.is_object() || !after.is_object()) return false;
  const auto is_view = [](const std::string& key) { return std::ranges::count(view_keys, key) > 0; };
  for (const auto& [key, value] : before.items())
    if (!is_view(key) && (!after.contains(key) || after[key] != value)) return false;
  for (const auto& [key, value] : after.items())
    if (!is_view(key) && !before.contains(key)) return false;
  return true;
}

/// Lights that rays meet are objects too (lamps.h).
bool has_lamps(const std::vector<LightDescription>& lights) {
  return std::ranges::any_of(
      lights, [](const LightDescription& light) { return facts_of(light.type).extent && light.visible; });
}

bool has_place(const json& document) {
  return document.contains("camera") && document["camera"].is_object() &&
         document["camera"].contains("position");
}

json model_document(const fs::path& path, const LoadOptions& options) {
  const auto [width, height] = options.size;
  const std::optional<double> aspect =
      width > 0 && height > 0 ? std::optional(static_cast<double>(width) / height) : std::nullopt;
  json document = make_model_scene(path, load_model(path, {.outside_files = options.outside_files}), aspect);
  take_ground_above(document, document["camera"]["position"][1].get<double>());
  return document;
}

}  // namespace

json read_scene_document(const fs::path& path, const LoadOptions& options) {
  require_readable(path, path, "");
  if (!is_model_file(path) && path.extension() != ".json")
    throw SceneError(path.string(), "", "wanted a scene (.json) or a model, found another extension");
  json document = is_model_file(path) ? model_document(path, options) : read_json_file(path, options.faults);
  const char* keys[] = {"width", "height"};
  for (std::size_t i = 0; i < 2 && document.is_object(); ++i)
    if (options.size[i] > 0) document["image"][keys[i]] = options.size[i];
  return document;
}

SceneDescription load_scene_document(const json& document, const fs::path& file, const LoadOptions& options,
                                     const NamedMeshes& made) {
  std::vector<std::string> warnings;
  const JsonContext context{.file = file,
                            .native_code = options.native_code,
                            .warnings = &warnings,
                            .outside_files = options.outside_files};
  SceneDescription scene = read_scene(JsonValue(document, context), std::nullopt, made);
  scene.warnings.insert(scene.warnings.end(), warnings.begin(), warnings.end());
  return scene;
}

std::shared_ptr<const SceneDescription> change_view(const SceneDescription& scene, const json& before,
                                                    const json& after) {
  if (!has_place(after) || !same_but_view(before, after)) return nullptr;
  const JsonContext context{.file = scene.file};
  const auto section = [&](const char* key) {
    return JsonValue(after[key], context, std::string("/") + key);
  };
  auto changed = std::make_shared<SceneDescription>(scene);
  bool placed = false;
  changed->camera = read_camera(section("camera"), placed);
  changed->image = after.contains("image") ? read_image(section("image")) : ImageSettings{};
  if (!after.contains("lights") || after["lights"] != before.value("lights", json())) {
    if (has_lamps(scene.lights)) return nullptr;
    changed->lights.clear();
    if (after.contains("lights"))
      for (const JsonValue& light : section("lights").items("lights"))
        changed->lights.push_back(read_light(light));
    if (has_lamps(changed->lights)) return nullptr;
  }
  changed->render = after.contains("render") ? read_render(section("render")) : RenderSettings{};
  // Images were made smaller to fit what they may take.
  if (changed->render.texture_memory != scene.render.texture_memory && !scene.images.empty()) return nullptr;
  return changed;
}

}  // namespace sundog
