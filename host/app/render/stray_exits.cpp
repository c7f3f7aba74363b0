// Blames objects with an interior whose meshes are open, partly turned or inside out (mesh_faults.h), or
// whose shapes are flat; if there are none, blames coincident surfaces.
#include "app/render/stray_exits.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <unordered_set>

#include "scene/mesh_faults.h"

namespace sundog {
namespace {

/// Names of objects without duplicates; lists the first few and counts the others.
class ObjectNames {
 public:
  void add(const std::string& name) {
    if (known_.insert(name).second && shown_.size() < most_shown + 1) shown_.push_back(name);
  }
  std::size_t size() const { return known_.size(); }
  bool empty() const { return known_.empty(); }

  /// "a, b, c, d and 5 more"
  std::string list() const {
    const std::size_t shown = size() > most_shown + 1 ? most_shown : size();
    std::string text = shown_[0];
    for (std::size_t i = 1; i < shown; ++i) text += (i + 1 == size() ? " and " : ", ") + shown_[i];
    return shown < size() ? fmt::format("{} and {} more", text, size() - shown) : text;
  }

 private:
  static constexpr std::size_t most_shown = 4;
  std::unordered_set<std::string> known_;
  std::vector<std::string> shown_;
};

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

/// Whether the shape encloses nothing, such as an open tube or a disk.
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

Suspects find_suspects(const SceneDescription& scene) {
  Suspects found;
  std::map<int, MeshFaults> faults;  // by mesh
  for (const Object& object : scene.objects) {
    if (!has_interior(scene, object)) continue;
    const std::string name = name_of(scene, object);
    found.all.add(name);
    if (is_flat(object.shape)) found.flat.add(name);
    const auto* shape = std::get_if<MeshShape>(&object.shape);
    if (!shape) continue;
    auto known = faults.find(shape->mesh);
    if (known == faults.end())
      known =
          faults.emplace(shape->mesh, find_faults(scene.meshes[static_cast<std::size_t>(shape->mesh)])).first;
    if (known->second.open_edges > 0)
      found.open.add(name);
    else if (known->second.turned_edges > 0)
      found.turned.add(name);
    else if (known->second.inside_out > 0)
      found.inside_out.add(name);
  }
  return found;
}

}  // namespace

std::string lost_pixels(const RayCounts& counts, const SceneDescription& scene) {
  const double all = double(scene.image.width) * scene.image.height;
  const double lost = std::min(all, double(counts[COUNT_LOST_PIXEL]));
  return fmt::format("in at most {:.0f} pixels ({:.2g} %)", lost, 100 * lost / all);
}

std::vector<std::string> explain_stray_exits(const RayCounts& counts, const SceneDescription& scene) {
  const Suspects found = find_suspects(scene);
  std::vector<std::string> sentences;
  const auto say = [&](const ObjectNames& names, const char* one, const char* several) {
    if (!names.empty())
      sentences.push_back(fmt::format("{} {}", names.list(), names.size() > 1 ? several : one));
  };
  say(found.inside_out, "is inside out: its triangles face inwards; turn them round in the model",
      "are inside out: their triangles face inwards; turn them round in the models");
  say(found.turned, "has triangles that face inwards beside others that face outwards",
      "have triangles that face inwards beside others that face outwards");
  say(found.open, "has an interior, but its mesh is not closed",
      "have an interior, but their meshes are not closed");
  say(found.flat, "has an interior, but its shape is not closed",
      "have an interior, but their shapes are not closed");
  std::string all = fmt::format("{} rays left a solid that they had not entered, {}",
                                counts[COUNT_STRAY_EXIT], lost_pixels(counts, scene));
  if (sentences.empty() && !found.all.empty())
    all += fmt::format(
        ": surfaces of {} may coincide; let one reach into the other, its medium with the higher "
        "\"priority\" wins, or leave a gap",
        found.all.list());
  sentences.insert(sentences.begin(), all);
  return sentences;
}

}  // namespace sundog
