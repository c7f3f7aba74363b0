// Frames the model with a camera, sets a key light and a sky for its brightest material, and adds a ground
// that blends with the background.
#include "scene/model_scene.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "scene/bounds.h"
#include "scene/kinds.h"
#include "scene/materials/conserve_light.h"

namespace sundog {
using nlohmann::json;

namespace {

json to_json(const dvec3& v) { return {v.x, v.y, v.z}; }

json to_json(const Camera& camera) {
  json result = {{"position", to_json(camera.position)},
                 {"target", to_json(camera.target)},
                 {"up", to_json(camera.up)},
                 {"near", camera.near}};
  const bool parallel = camera.orthographic > 0;
  result[parallel ? "orthographic" : "fov"] = parallel ? camera.orthographic : camera.fov;
  if (std::isfinite(camera.far)) result["far"] = camera.far;
  return result;
}

json to_json(const LightDescription& light) {
  const LightTypeFacts& facts = facts_of(light.type);
  json result = {
      {"type", std::string(facts.name)}, {"color", to_json(light.color)}, {"intensity", light.intensity}};
  if (facts.aimed) result["direction"] = to_json(light.direction);
  if (facts.placed) {
    result["position"] = to_json(light.position);
    result["falloff"] = {
        {"constant", light.falloff.x}, {"linear", light.falloff.y}, {"quadratic", light.falloff.z}};
    if (light.range > 0) result["range"] = light.range;
  }
  if (light.type == LightType::spot) {
    // glTF allows a spot's cone to be a full hemisphere.
    result["outer_angle"] = std::min(light.outer_angle, 89.99);
    result["inner_angle"] = std::min(light.inner_angle, 89.99);
    result["square_edge"] = light.square_edge;
  }
  return result;
}

double greatest(const dvec3& color) { return std::max({color.x, color.y, color.z}); }

/// The greatest reflectance of the model's materials facing a light, as read for paths.
double brightness_of(const Model& model) {
  double vertex_color = 0, brightest = 0;
  for (const Mesh& mesh : model.meshes)
    for (const glm::vec3& color : mesh.colors) vertex_color = std::max(vertex_color, greatest(dvec3(color)));
  const auto add = [&](MaterialDescription m) {
    conserve_light(m);
    const double color = m.vertex_color ? vertex_color : 1;
    const double broad = 20 / std::max(m.exponent, 20.0);  // a narrow highlight may be white
    brightest = std::max(brightest, color * greatest(m.diffuse) + broad * greatest(m.specular));
  };
  std::ranges::for_each(model.materials, add);
  const auto is_grey = [&](const Object& object) {  // it gets a generated material
    const auto* shape = std::get_if<MeshShape>(&object.shape);
    return object.material < 0 &&
           (!shape || model.meshes[static_cast<std::size_t>(shape->mesh)].materials.empty());
  };
  if (std::ranges::any_of(model.objects, is_grey)) add({});
  return brightest;
}

/// A soft key light above the camera's left shoulder, and a sky of the background's colours.
struct MadeUpLights {
  dvec3 direction;
  double key = 0, sky = 0;  // intensities
  dvec3 bottom, top;        // colours of the sky
  /// The light reflected by a white ground.
  dvec3 on_ground() const {
    const dvec3 above =
        glm::mix(bottom, top, 5.0 / 6);  // its mean over the hemisphere, weighted by the cosine
    return sky * above - key * direction.y;
  }
};

/// Exposes the model's brightest material to 0.75 where it faces the key light and the zenith; light from
/// surrounding objects adds to that. Treats dark materials as at least 0.5 bright, which limits their lights.
MadeUpLights expose(const Model& model, const Camera& camera, const ImageSettings& image) {
  const dvec3 forward = glm::normalize(camera.target - camera.position);
  const dvec3 right = glm::normalize(glm::cross(forward, camera.up));
  const dvec3 up = glm::cross(right, forward);
  const double all = 0.75 / std::max(brightness_of(model), 0.5);
  MadeUpLights lights{glm::normalize(forward + 0.6 * right - 0.7 * up), 0.6 * all, 0, image.background_bottom,
                      image.background_top};
  lights.sky = 0.4 * all / std::max(greatest(glm::mix(lights.bottom, lights.top, 5.0 / 6)), 0.05);
  return lights;
}

json key_light(const MadeUpLights& lights) {
  return {{{"type", "directional"},
           {"direction", to_json(lights.direction)},
           {"intensity", lights.key},
           {"angle", 4},
           {"visible", false}}};
}

json soft_sky(const MadeUpLights& lights) {
  return {{"type", "gradient"},
          {"bottom", to_json(lights.bottom)},
          {"top", to_json(lights.top)},
          {"intensity", lights.sky},
          {"visible", false}};
}

json background(const ImageSettings& image, double share) {
  return {{"bottom", to_json(share * image.background_bottom)},
          {"top", to_json(share * image.background_top)}};
}

/// Adds a matte plane just below the model for its shadow. Lit, it matches the background at the horizon, so
/// no edge shows. Adds none for a camera below it.
void add_ground(json& document, const SceneBounds& bounds, const Camera& camera, const ImageSettings& image,
                const MadeUpLights& lights) {
  const double height = bounds.lower.y - 1e-3 * glm::length(bounds.upper - bounds.lower);
  if (camera.position.y <= height || lights.direction.y >= 0) return;
  const dvec3 horizon = 0.5 * (image.background_bottom + image.background_top);
  const dvec3 wanted = horizon / lights.on_ground();
  // The ground reflects no more light than white paint; under weak lights the background is darkened instead.
  const double share = std::min(1.0, 0.8 / greatest(wanted));
  document["materials"]["ground"] = {{"color", to_json(share * wanted)}, {"diffuse", 1}};
  document["image"]["background"] = background(image, share);
  const dvec3 centre = 0.5 * (bounds.lower + bounds.upper);
  document["objects"].push_back({{"type", "plane"},
                                 {"name", "ground"},
                                 {"point", to_json(dvec3(centre.x, height, centre.z))},
                                 {"material", "ground"}});
}

/// Gives the image these proportions; its longer edge stays.
void fit(ImageSettings& image, double aspect) {
  const int longer = std::max(image.width, image.height);
  image.width = std::max(1, static_cast<int>(std::lround(longer * std::min(aspect, 1.0))));
  image.height = std::max(1, static_cast<int>(std::lround(longer / std::max(aspect, 1.0))));
}

SceneBounds bounds_of_motion(const std::filesystem::path& file, const Model& model) {
  constexpr int poses = 16;
  SceneBounds bounds;
  double duration = 0;
  for (int i = 0; i <= poses; ++i) {
    const Model at = posed(model, file, {.seconds = duration * i / poses});
    duration = at.duration;
    const SceneBounds more = bounds_of(at.objects, at.meshes);
    if (!more.empty()) bounds.add(more.lower), bounds.add(more.upper);
  }
  return bounds;
}

}  // namespace

json make_model_scene(const std::filesystem::path& file, const Model& model, std::optional<double> aspect,
                      bool plays) {
  ImageSettings image;
  image.background_bottom = {0.75, 0.75, 0.75}, image.background_top = {0.35, 0.42, 0.5};
  if (model.aspect) fit(image, *model.aspect);
  image = model.image.value_or(image);
  const double fitted = aspect.value_or(static_cast<double>(image.width) / image.height);
  const SceneBounds bounds = plays && model.pose && !model.camera ? bounds_of_motion(file, model)
                                                                  : bounds_of(model.objects, model.meshes);
  const Camera camera = model.camera ? *model.camera : frame(bounds, fitted, {});
  const MadeUpLights made_up = expose(model, camera, image);
  json document = {
      {"camera", to_json(camera)},
      {"image", {{"width", image.width}, {"height", image.height}, {"background", background(image, 1)}}},
      {"render", json::object()},
      {"materials", json::object()},
      {"lights", key_light(made_up)},
      {"objects", {{{"type", "model"}, {"file", file.filename().string()}, {"conserve", true}}}}};
  if (model.lights.empty()) {
    document["environment"] = soft_sky(made_up);
    // Limits samples: the key light reflected by shiny materials would leave bright dots on matte surfaces.
    document["render"] = {{"integrator", "path"}, {"samples", 64}, {"max_component", 4}};
  }
  set_view(document, model);
  if (!model.camera && model.lights.empty() && !bounds.empty())
    add_ground(document, bounds, camera, image, made_up);
  return document;
}

void set_view(json& document, const Model& model) {
  if (model.camera) document["camera"] = to_json(*model.camera);
  if (model.lights.empty()) return;
  document["lights"] = json::array();
  for (const LightDescription& light : model.lights) document["lights"].push_back(to_json(light));
}

void take_ground_above(json& document, double height) {
  json& objects = document["objects"];
  if (objects.size() < 2 || objects[1]["point"][1].get<double>() < height) return;
  objects.erase(1);
  document["materials"].erase("ground");
}

}  // namespace sundog
