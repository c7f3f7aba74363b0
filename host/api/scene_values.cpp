// Writes the public structs (Camera, Material, Light, ...) into a scene's document.
#include <algorithm>
#include <cmath>

#include "api/impl.h"
#include "base/json_text.h"
#include "scene/json/schema.h"

namespace sundog {
inline namespace v0 {
namespace {

using nlohmann::json;

/// Returns a member of the document, created as `empty` if missing. Throws Error (usage) if it has another
/// type.
json& member(json& document, const char* key, const json& empty) {
  const std::string place = document.is_object() ? std::string("/") + key : "";
  if (document.is_object() && !document.contains(key)) document[key] = empty;
  if (!document.is_object() || document[key].type() != empty.type()) {
    const std::string reason =
        empty.is_array() && !place.empty() ? "wanted an array to add to" : "wanted an object to add to";
    throw Error(ErrorKind::usage, place + ": " + reason,
                {.file = {}, .place = place, .reason = reason, .log = {}});
  }
  return document[key];
}

void append(json& document, const char* list, json value) {
  member(document, list, json::array()).push_back(std::move(value));
}

/// Adds an object. Without a material it gets "default", which is added to the document if missing.
void place(json& document, json object, const Placement& placement) {
  json& objects = member(document, "objects", json::array());
  const std::string material = placement.material.empty() ? "default" : placement.material;
  if (placement.material.empty())
    member(document, "materials", json::object()).emplace(material, json::object());
  object["material"] = material;
  if (!placement.name.empty()) object["name"] = placement.name;
  if (placement.transform != identity) object["transform"] = json::array({{{"matrix", placement.transform}}});
  objects.push_back(std::move(object));
}

json light_json(const Light& light) {
  json value{{"type", light.type}, {"color", light.color}, {"intensity", light.intensity}};
  const SchemaRule* rule = schema_rule(light.type + "_light");
  if (!rule) return value;  // the scene reader reports the unknown type
  const auto put = [&](const char* key, const auto& member) {
    if (rule->keys.contains(key)) value[key] = member;
  };
  put("position", light.position);
  put("direction", light.direction);
  put("samples", light.samples);
  put("outer_angle", light.angle);
  put("size", light.size);
  put("radius", light.radius);
  for (const auto& [key, number] : light.more) value[key] = number;
  return value;
}

json material_json(const Material& material) {
  json value{{"type", material.type}};
  if (material.color != Vec3{1, 1, 1}) value["color"] = material.color;  // glass has no colour
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

/// Shares the numbers if they have an owner, else copies them.
template <class To, class From, std::size_t count>
sundog::MeshArray<To> held(std::span<const std::array<From, count>> from, std::shared_ptr<const void> owner) {
  static_assert(sizeof(To) == sizeof from[0] && alignof(To) == alignof(From));
  if (!owner) {
    auto copy = std::make_shared<const std::vector<std::array<From, count>>>(from.begin(), from.end());
    from = *copy;
    owner = std::move(copy);
  }
  return sundog::MeshArray<To>::held({reinterpret_cast<const To*>(from.data()), from.size()},
                                     std::move(owner));
}

template <class To, std::size_t count>
sundog::MeshArray<To> vertices(const std::string& name, const char* what,
                               std::span<const std::array<float, count>> from, const MeshView& view) {
  if (from.empty()) return {};
  const std::size_t wanted = view.positions.size();
  if (from.size() != wanted)
    refuse(name, "wanted " + std::to_string(wanted) + " " + what + ", one a position, found " +
                     std::to_string(from.size()));
  for (std::size_t i = 0; i < from.size(); ++i)
    if (!std::ranges::all_of(from[i], [](float number) { return std::isfinite(number); }))
      refuse(name, std::string(what) + " " + std::to_string(i) + " is not finite");
  return held<To>(from, view.owner);
}

Mesh mesh_of(const std::string& name, const MeshView& view) {
  if (view.triangles.empty()) refuse(name, "wanted a triangle or more");
  Mesh mesh;
  mesh.name = name;
  mesh.positions = vertices<glm::vec3>(name, "positions", view.positions, view);
  mesh.normals = vertices<glm::vec3>(name, "normals", view.normals, view);
  mesh.uvs = vertices<glm::vec2>(name, "uvs", view.uvs, view);
  mesh.colors = vertices<glm::vec3>(name, "colors", view.colors, view);
  const std::size_t count = view.positions.size();
  for (std::size_t i = 0; i < view.triangles.size(); ++i)
    for (const std::uint32_t corner : view.triangles[i])
      if (corner >= count)
        refuse(name, "triangle " + std::to_string(i) + " has the corner " + std::to_string(corner) +
                         "; wanted one of " + std::to_string(count) + " positions, counted from 0");
  mesh.triangles = held<glm::uvec3>(view.triangles, view.owner);
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
  return set("/camera", json_text(value));
}

Scene& Scene::set_background(const Vec3& bottom, const Vec3& top) {
  return set("/image/background", json_text(json{{"bottom", bottom}, {"top", top}}));
}

Scene& Scene::add_light(const Light& light) {
  append(impl_->document, "lights", light_json(light));
  return *this;
}

Scene& Scene::add_material(const std::string& name, const Material& material) {
  member(impl_->document, "materials", json::object())[name] = material_json(material);
  return *this;
}

Scene& Scene::add_mesh(const std::string& name, const MeshView& mesh) {
  impl_->meshes.insert_or_assign(name, std::make_shared<const Mesh>(mesh_of(name, mesh)));
  impl_->forget_description();
  return *this;
}

Scene& Scene::add_instance(const std::string& mesh, const Placement& placement) {
  place(impl_->document, {{"type", "mesh"}, {"mesh", mesh}}, placement);
  return *this;
}

Scene& Scene::add_sphere(const Vec3& center, double radius, const Placement& placement) {
  place(impl_->document, {{"type", "sphere"}, {"center", center}, {"radius", radius}}, placement);
  return *this;
}

Scene& Scene::add_box(const Vec3& low, const Vec3& high, const Placement& placement) {
  place(impl_->document, {{"type", "box"}, {"min", low}, {"max", high}}, placement);
  return *this;
}

Scene& Scene::add_plane(const Vec3& point, const Vec3& normal, const Placement& placement) {
  place(impl_->document, {{"type", "plane"}, {"point", point}, {"normal", normal}}, placement);
  return *this;
}

Scene& Scene::add_formula(const Formula& formula, const Placement& placement) {
  json object{{"type", "formula"}, {"interval", {{"min", formula.low}, {"max", formula.high}}}};
  if (!formula.map.empty()) object["map"] = formula.map;
  if (!formula.distance.empty()) object["distance"] = formula.distance;
  for (const auto& [name, value] : formula.parameters) object["parameters"][name] = value;
  if (formula.iterations != 0) object["iterations"] = formula.iterations;
  if (formula.bailout != 0) object["bailout"] = formula.bailout;
  place(impl_->document, std::move(object), placement);
  return *this;
}

}  // namespace v0
}  // namespace sundog
