#include "scene/model_scene.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "scene/bounds.h"

namespace sundog {
using nlohmann::json;

namespace {

json to_json(const dvec3& v) { return {v.x, v.y, v.z}; }

json to_json(const Camera& camera) {
  json result = {{"position", to_json(camera.position)},
                 {"target", to_json(camera.target)},
                 {"up", to_json(camera.up)},
                 {"fov", camera.fov},
                 {"near", camera.near}};
  if (std::isfinite(camera.far)) result["far"] = camera.far;
  return result;
}

json to_json(const LightDescription& light) {
  static constexpr const char* names[] = {"ambient", "directional", "point", "spot"};
  json result = {{"type", names[static_cast<int>(light.type)]},
                 {"color", to_json(light.color)},
                 {"intensity", light.intensity}};
  const bool spot = light.type == LightType::spot;
  if (light.type == LightType::directional || spot) result["direction"] = to_json(light.direction);
  if (light.type == LightType::point || spot) {
    result["position"] = to_json(light.position);
    result["falloff"] = {
        {"constant", light.falloff.x}, {"linear", light.falloff.y}, {"quadratic", light.falloff.z}};
  }
  if (spot) {
    // glTF lets a cone open to a full half space.
    result["outer_angle"] = std::min(light.outer_angle, 89.99);
    result["inner_angle"] = std::min(light.inner_angle, 89.99);
  }
  return result;
}

/// A key light from above the camera's left shoulder, and an ambient one.
json make_lights(const Camera& camera) {
  const dvec3 forward = glm::normalize(camera.target - camera.position);
  const dvec3 right = glm::normalize(glm::cross(forward, camera.up));
  const dvec3 up = glm::cross(right, forward);
  return {{{"type", "ambient"}, {"intensity", 1.0}},
          {{"type", "directional"},
           {"direction", to_json(forward + 0.6 * right - 0.7 * up)},
           {"intensity", 0.9}}};
}

}  // namespace

json make_model_scene(const std::filesystem::path& file, const Model& model, std::optional<double> aspect) {
  ImageSettings image;
  image.background_bottom = {0.75, 0.75, 0.75}, image.background_top = {0.35, 0.42, 0.5};
  image = model.image.value_or(image);
  const double fitted = aspect.value_or(static_cast<double>(image.width) / image.height);
  const Camera camera =
      model.camera ? *model.camera : frame(bounds_of(model.objects, model.meshes), fitted, {});
  json lights = json::array();
  for (const LightDescription& light : model.lights) lights.push_back(to_json(light));
  return {{"camera", to_json(camera)},
          {"image",
           {{"width", image.width},
            {"height", image.height},
            {"background",
             {{"bottom", to_json(image.background_bottom)}, {"top", to_json(image.background_top)}}}}},
          {"render", json::object()},
          {"materials", json::object()},
          {"lights", lights.empty() ? make_lights(camera) : lights},
          {"objects", {{{"type", "model"}, {"file", file.filename().string()}}}}};
}

}  // namespace sundog
