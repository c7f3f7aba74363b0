// See bench_scenes.h.
#include "bench_scenes.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <tuple>

#include "models/model.h"
#include "scene/load.h"

namespace sundog {
namespace {

using u32 = std::uint32_t;
using Edge = std::pair<u32, u32>;

/// The edges of one triangle alone, in its direction, by the first place with that position.
std::map<u32, std::vector<u32>> open_edges(const Mesh& mesh) {
  std::map<std::tuple<float, float, float>, u32> places;
  std::vector<u32> place;
  for (u32 i = 0; i < mesh.positions.size(); ++i) {
    const glm::vec3& p = mesh.positions[i];
    place.push_back(places.emplace(std::tuple(p.x, p.y, p.z), i).first->second);
  }
  std::set<Edge> edges;
  for (const glm::uvec3& t : mesh.triangles)
    for (int i = 0; i < 3; ++i) edges.emplace(place[t[i]], place[t[(i + 1) % 3]]);
  std::map<u32, std::vector<u32>> open;
  for (const auto& [from, to] : edges)
    if (!edges.count({to, from})) open[from].push_back(to);
  return open;
}

/// A flat-looking fan around the middle of a loop of open edges, with vertices of its own.
void close_hole(Mesh& mesh, const std::vector<u32>& loop) {
  const auto first = static_cast<u32>(mesh.positions.size()), count = static_cast<u32>(loop.size());
  glm::vec3 middle(0), normal(0);
  for (const u32 i : loop) {
    mesh.positions.push_back(mesh.positions[i]);
    middle += mesh.positions[i] / static_cast<float>(count);
  }
  mesh.positions.push_back(middle);
  for (u32 i = 0; i < count; ++i) {
    const u32 a = first + (i + 1) % count, b = first + i;
    normal += glm::cross(mesh.positions[a] - middle, mesh.positions[b] - middle);
    mesh.triangles.emplace_back(a, b, first + count);
  }
  if (mesh.normals.empty()) return;
  if (!(glm::length(normal) > 0)) normal = {0, -1, 0};
  mesh.normals.resize(mesh.positions.size(), glm::normalize(normal));
}

/// Scans have holes below, and programs differ in what they make of a ray that leaves glass through one.
void close_holes(Mesh& mesh) {
  std::map<u32, std::vector<u32>> open = open_edges(mesh);
  while (!open.empty()) {
    std::vector<u32> loop;
    for (auto at = open.begin(); at != open.end();) {
      loop.push_back(at->first);
      const u32 next = at->second.back();
      at->second.pop_back();
      if (at->second.empty()) open.erase(at);
      at = open.find(next);
    }
    close_hole(mesh, loop);
  }
}

/// Scales a mesh to two units in its greatest extent and puts it at the origin, its foot in the floor at y =
/// 0: the ragged underside of a scan is not seen.
void stand_on_floor(Mesh& mesh) {
  constexpr float size = 2, below = 0.11f;
  glm::vec3 lower(std::numeric_limits<float>::max()), upper = -lower;
  for (const glm::vec3& p : mesh.positions) lower = glm::min(lower, p), upper = glm::max(upper, p);
  const glm::vec3 extent = upper - lower,
                  foot(0.5f * (lower.x + upper.x), lower.y, 0.5f * (lower.z + upper.z));
  const float scale = size / std::max({extent.x, extent.y, extent.z});
  for (glm::vec3& p : mesh.positions) p = scale * (p - foot) - glm::vec3(0, below, 0);
}

}  // namespace

SceneDescription scene_of_model(const std::string& path, bool spatial_splits) {
  if (path.ends_with(".json")) {
    SceneDescription scene = load_scene(path, {}, {.outside_files = true});
    if (spatial_splits) scene.render.spatial_splits = true;
    return scene;
  }
  Model model = load_model(path);
  SceneDescription scene;
  scene.file = path;
  scene.media.resize(1);
  scene.render.spatial_splits = spatial_splits;
  scene.materials = std::move(model.materials);
  scene.meshes = std::move(model.meshes);
  scene.objects = std::move(model.objects);
  return scene;
}

SceneDescription glass_scene(const std::string& model, std::vector<std::string> overrides) {
  const nlohmann::json file = std::filesystem::absolute(model).string();
  overrides.push_back("/meshes/model/file=" + file.dump());
  SceneDescription scene =
      load_scene(SUNDOG_SOURCE_DIR "/bench/scenes/glass_model.json", overrides, {.outside_files = true});
  Mesh& mesh = scene.meshes.at(0);
  mesh.colors.clear();
  mesh.uvs.clear();
  close_holes(mesh);
  stand_on_floor(mesh);
  return scene;
}

nlohmann::json to_json(const Spread& s) { return {{"median", s.median}, {"min", s.min}, {"max", s.max}}; }

}  // namespace sundog
