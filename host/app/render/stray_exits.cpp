// See stray_exits.h.
#include "app/render/stray_exits.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "scene/mesh_faults.h"

namespace sundog {
namespace {

using ObjectNames = std::vector<std::string>;

struct Suspects {
  ObjectNames inside_out, turned, open, flat, all;
};

bool has_interior(const SceneDescription& scene, int material) {
  if (material < 0) return false;
  const MaterialDescription& m = scene.materials[static_cast<std::size_t>(material)];
  return m.medium >= 0 && m.transmission != dvec3(0);
}

bool has_interior(const SceneDescription& scene, const Object& object) {
  const auto* shape = std::get_if<MeshShape>(&object.shape);
  if (!shape || object.material >= 0) return has_interior(scene, object.material);
  const std::vector<int>& materials = scene.meshes[static_cast<std::size_t>(shape->mesh)].materials;
  return std::ranges::any_of(materials, [&](int material) { return has_interior(scene, material); });
}

/// An open tube or a disk.
bool is_flat(const Shape& shape) {
  return std::visit(
      [](const auto& s) {
        if constexpr (requires { s.open(); })
          return s.open();
        else
          return false;  // meshes and fields
      },
      shape);
}

std::string name_of(const SceneDescription& scene, const Object& object) {
  if (!object.name.empty()) return fmt::format("\"{}\"", object.name);
  if (!object.place.empty()) return object.place;
  return fmt::format("object {}", &object - scene.objects.data());
}

void add_name(ObjectNames& names, const std::string& name) {
  if (std::ranges::find(names, name) == names.end()) names.push_back(name);
}

Suspects find_suspects(const SceneDescription& scene) {
  Suspects found;
  std::map<int, MeshFaults> faults;  // by mesh
  for (const Object& object : scene.objects) {
    if (!has_interior(scene, object)) continue;
    const std::string name = name_of(scene, object);
    add_name(found.all, name);
    if (is_flat(object.shape)) add_name(found.flat, name);
    const auto* shape = std::get_if<MeshShape>(&object.shape);
    if (!shape) continue;
    auto known = faults.find(shape->mesh);
    if (known == faults.end())
      known =
          faults.emplace(shape->mesh, find_faults(scene.meshes[static_cast<std::size_t>(shape->mesh)])).first;
    if (known->second.open_edges > 0)
      add_name(found.open, name);
    else if (known->second.turned_edges > 0)
      add_name(found.turned, name);
    else if (known->second.inside_out > 0)
      add_name(found.inside_out, name);
  }
  return found;
}

std::string list(const ObjectNames& names) {
  constexpr std::size_t most = 4;
  const std::size_t shown = names.size() > most + 1 ? most : names.size();
  std::string text = names[0];
  for (std::size_t i = 1; i < shown; ++i) text += (i + 1 == names.size() ? " and " : ", ") + names[i];
  return shown < names.size() ? fmt::format("{} and {} more", text, names.size() - shown) : text;
}

}  // namespace

std::vector<std::string> explain_stray_exits(std::uint64_t count, const SceneDescription& scene) {
  const Suspects found = find_suspects(scene);
  std::vector<std::string> sentences;
  const auto say = [&](const ObjectNames& names, const char* one, const char* several) {
    if (!names.empty())
      sentences.push_back(fmt::format("{} {}", list(names), names.size() > 1 ? several : one));
  };
  say(found.inside_out, "is inside out: its triangles face inwards; turn them round in the model",
      "are inside out: their triangles face inwards; turn them round in the models");
  say(found.turned, "has triangles that face inwards beside others that face outwards",
      "have triangles that face inwards beside others that face outwards");
  say(found.open, "has an interior, but its mesh is not closed",
      "have an interior, but their meshes are not closed");
  say(found.flat, "has an interior, but its shape is not closed",
      "have an interior, but their shapes are not closed");
  std::string all = fmt::format("{} rays left a solid that they had not entered", count);
  if (sentences.empty() && !found.all.empty()) all += ": surfaces of " + list(found.all) + " may coincide";
  sentences.insert(sentences.begin(), all);
  return sentences;
}

}  // namespace sundog
