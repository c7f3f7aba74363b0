// Values in code, as the keys of a scene's document.
#include <algorithm>
#include <cmath>

#include "api/impl.h"

namespace sundog {
inline namespace v0 {
namespace {

using nlohmann::json;

void put_placement(json& object, const Placement& placement) {
  if (!placement.material.empty()) object["material"] = placement.material;
  if (!placement.name.empty()) object["name"] = placement.name;
  if (placement.transform != identity) object["transform"] = json::array({{{"matrix", placement.transform}}});
}

/// Appends to a list of the document, which it makes where there is none.
void append(json& document, const char* list, json value) {
  json& items = document[list];
  if (items.is_null()) items = json::array();
  if (!items.is_array())
    throw Error(
        ErrorKind::usage, std::string("/") + list + ": wanted an array to add to",
        {.file = {}, .place = std::string("/") + list, .reason = "wanted an array to add to", .log = {}});
  items.push_back(std::move(value));
}

json aimed(const Light& light) { return {{"position", light.position}, {"direction", light.direction}}; }

json light_json(const Light& light) {
  json value{{"type", light.type}, {"color", light.color}, {"intensity", light.intensity}};
  if (light.type == "directional") value["direction"] = light.direction;
  if (light.type == "point") value["position"] = light.position;
  if (light.type == "spot") {
    value.update(aimed(light));
    value["outer_angle"] = light.angle;
  }
  if (light.type == "rectangle" || light.type == "disk") value.update(aimed(light));
  if (light.type == "rectangle") value["size"] = light.size;
  if (light.type == "sphere") value["position"] = light.position;
  if (light.type == "disk" || light.type == "sphere") value["radius"] = light.radius;
  if (light.type == "rectangle" || light.type == "disk" || light.type == "sphere")
    value["samples"] = light.samples;
  return value;
}

json material_json(const Material& material) {
  json value{{"type", material.type}, {"color", material.color}};
  const auto put = [&](const char* key, const std::optional<double>& number) {
    if (number) value[key] = *number;
  };
  put("ambient", material.ambient);
  put("diffuse", material.diffuse);
  put("reflection", material.reflection);
  put("transmission", material.transmission);
  put("ior", material.ior);
  if (material.specular != 0)
    value["specular"] = {{"coefficient", material.specular}, {"exponent", material.exponent}};
  if (material.roughness != 0) value["roughness"] = material.roughness;
  if (material.emission != Vec3{0, 0, 0}) value["emission"] = material.emission;
  return value;
}

[[noreturn]] void refuse(const std::string& name, const std::string& why) {
  throw Error(ErrorKind::usage, "mesh \"" + name + "\": " + why);
}

template <class To, std::size_t count>
std::vector<To> copied(const std::string& name, const char* what,
                       std::span<const std::array<float, count>> from, std::size_t wanted) {
  if (from.size() != wanted)
    refuse(name, "wanted " + std::to_string(wanted) + " " + what + ", one a position, found " +
                     std::to_string(from.size()));
  std::vector<To> to(from.size());
  for (std::size_t i = 0; i < from.size(); ++i)
    for (std::size_t axis = 0; axis < count; ++axis) {
      if (!std::isfinite(from[i][axis]))
        refuse(name, std::string(what) + " " + std::to_string(i) + " is not finite");
      to[i][static_cast<int>(axis)] = from[i][axis];
    }
  return to;
}

core::Mesh mesh_of(const std::string& name, const MeshView& view) {
  if (view.triangles.empty()) refuse(name, "wanted a triangle or more");
  core::Mesh mesh;
  mesh.name = name;
  const std::size_t count = view.positions.size();
  mesh.positions = copied<glm::vec3>(name, "positions", view.positions, count);
  if (!view.normals.empty()) mesh.normals = copied<glm::vec3>(name, "normals", view.normals, count);
  if (!view.uvs.empty()) mesh.uvs = copied<glm::vec2>(name, "uvs", view.uvs, count);
  if (!view.colors.empty()) mesh.colors = copied<glm::vec3>(name, "colors", view.colors, count);
  mesh.triangles.reserve(view.triangles.size());
  for (std::size_t i = 0; i < view.triangles.size(); ++i) {
    const auto& corners = view.triangles[i];
    for (const std::uint32_t corner : corners)
      if (corner >= count)
        refuse(name, "triangle " + std::to_string(i) + " has the corner " + std::to_string(corner) +
                         "; wanted one of " + std::to_string(count) + " positions, counted from 0");
    mesh.triangles.emplace_back(corners[0], corners[1], corners[2]);
  }
  mesh.source_vertex_count = count;
  return mesh;
}

}  // namespace

Scene& Scene::set_size(int width, int height) {
  return set("/image/width", std::to_string(width)).set("/image/height", std::to_string(height));
}

Scene& Scene::set_samples(int samples) { return set("/render/samples", std::to_string(samples)); }

Scene& Scene::set_camera(const Camera& camera) {
  json value{
      {"position", camera.position}, {"target", camera.target}, {"up", camera.up}, {"fov", camera.fov}};
  if (camera.lens_radius != 0) value["lens"]["radius"] = camera.lens_radius;
  if (camera.focus != 0) value["lens"]["focus"] = camera.focus;
  return set("/camera", value.dump());
}

Scene& Scene::set_background(const Vec3& bottom, const Vec3& top) {
  return set("/image/background", json{{"bottom", bottom}, {"top", top}}.dump());
}

Scene& Scene::add_light(const Light& light) {
  append(impl_->document, "lights", light_json(light));
  return *this;
}

Scene& Scene::add_material(const std::string& name, const Material& material) {
  impl_->document["materials"][name] = material_json(material);
  return *this;
}

Scene& Scene::add_mesh(const std::string& name, const MeshView& mesh) {
  impl_->meshes.insert_or_assign(name, std::make_shared<const core::Mesh>(mesh_of(name, mesh)));
  impl_->forget_description();
  return *this;
}

Scene& Scene::add_instance(const std::string& mesh, const Placement& placement) {
  json object{{"type", "mesh"}, {"mesh", mesh}};
  put_placement(object, placement);
  append(impl_->document, "objects", std::move(object));
  return *this;
}

Scene& Scene::add_sphere(const Vec3& center, double radius, const Placement& placement) {
  json object{{"type", "sphere"}, {"center", center}, {"radius", radius}};
  put_placement(object, placement);
  append(impl_->document, "objects", std::move(object));
  return *this;
}

Scene& Scene::add_box(const Vec3& low, const Vec3& high, const Placement& placement) {
  json object{{"type", "box"}, {"min", low}, {"max", high}};
  put_placement(object, placement);
  append(impl_->document, "objects", std::move(object));
  return *this;
}

Scene& Scene::add_plane(const Vec3& point, const Vec3& normal, const Placement& placement) {
  json object{{"type", "plane"}, {"point", point}, {"normal", normal}};
  put_placement(object, placement);
  append(impl_->document, "objects", std::move(object));
  return *this;
}

Scene& Scene::add_formula(const Formula& formula, const Placement& placement) {
  json object{{"type", "formula"}, {"interval", {{"min", formula.low}, {"max", formula.high}}}};
  if (!formula.map.empty()) object["map"] = formula.map;
  if (!formula.distance.empty()) object["distance"] = formula.distance;
  for (const auto& [name, value] : formula.parameters) object["parameters"][name] = value;
  if (formula.iterations != 0) object["iterations"] = formula.iterations;
  if (formula.bailout != 0) object["bailout"] = formula.bailout;
  put_placement(object, placement);
  append(impl_->document, "objects", std::move(object));
  return *this;
}

}  // namespace v0
}  // namespace sundog
