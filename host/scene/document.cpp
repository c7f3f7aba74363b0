// Re-reads only camera, image, render, lights and surfaces, which viewers change up to sixty times a second;
// returns null for any other change.
#include "scene/document.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "scene/integrators.h"
#include "scene/json/value.h"
#include "scene/lamps.h"
#include "scene/read/focus.h"
#include "scene/read/parts.h"
#include "scene/read/surfaces.h"

namespace sundog {
using nlohmann::json;

namespace {

constexpr std::array<std::string_view, 4> view_keys = {"camera", "image", "render", "lights"};

bool is_among(std::string_view key, Names keys) { return std::ranges::count(keys, key) > 0; }

bool same_but(const json& before, const json& after, const auto& is_left_out) {
  if (!before.is_object() || !after.is_object()) return false;
  for (const auto& [key, value] : before.items())
    if (!is_left_out(key) && (!after.contains(key) || after[key] != value)) return false;
  for (const auto& [key, value] : after.items())
    if (!is_left_out(key) && !before.contains(key)) return false;
  return true;
}

bool same_section(const json& before, const json& after, std::string_view key) {
  const auto a = before.find(key), b = after.find(key);
  return a == before.end() ? b == after.end() : b != after.end() && *a == *b;
}

/// Removes the objects of visible lights, each with its own material, from the end of the scene (lamps.h).
void drop_lamps(SceneDescription& scene) {
  while (!scene.objects.empty() && scene.objects.back().light >= 0) {
    scene.objects.pop_back();
    scene.materials.pop_back();
  }
}

bool has_place(const json& document) {
  return document.contains("camera") && document["camera"].is_object() &&
         document["camera"].contains("position");
}

}  // namespace

std::shared_ptr<const SceneDescription> change_scene(const SceneDescription& scene, const json& before,
                                                     const json& after, const LoadOptions& options) {
  const auto is_read_here = [](const std::string& key) {
    return is_among(key, view_keys) || is_among(key, surface_sections());
  };
  if (!same_but(before, after, is_read_here) || !has_place(after)) return nullptr;
  const JsonContext context{
      .file = scene.file, .native_code = options.native_code, .outside_files = options.outside_files};
  auto changed = std::make_shared<SceneDescription>(scene);
  read_view_sections(
      [&](std::string_view key) {
        const auto found = after.find(key);
        return found == after.end() ? std::nullopt
                                    : std::optional(JsonObject::section("scene", key, *found, context));
      },
      *changed);
  if (const Lens& lens = scene.camera.lens; !changed->camera.lens.focus_on.empty()) {
    if (lens.focus_on != changed->camera.lens.focus_on) return nullptr;
    changed->camera.lens.focus_point = lens.focus_point;
    focus_on_point(*changed);
  }
  // A model's materials were read for one kind of integrator.
  const auto own_materials = [](const SceneDescription& s) {
    return integrator_of(s.render.integrator).own_materials;
  };
  if (scene.has_models && own_materials(*changed) != own_materials(scene)) return nullptr;
  // Images have been reduced to fit the old limit.
  if (changed->render.texture_memory != scene.render.texture_memory && !scene.images.empty()) return nullptr;
  const bool same_surfaces = std::ranges::all_of(
      surface_sections(), [&](std::string_view key) { return same_section(before, after, key); });
  if (!same_surfaces && !change_surfaces(*changed, before, after, context)) return nullptr;
  if (!same_section(before, after, "lights")) {
    drop_lamps(*changed);
    add_lamps(*changed);
  }
  check_light_groups(*changed, JsonValue(after, context));
  return changed;
}

}  // namespace sundog
