// Joins up to 16 meshes with the same transform, placed once each, whose boxes overlap by a quarter of the
// smaller's area.
#include "compile/bvh/mesh_groups.h"

#include <algorithm>
#include <numeric>

#include "compile/bounds.h"

namespace sundog {
namespace {

constexpr std::size_t most_sharing = 16;  // instances of a BVH are contiguous, so leaves stay close
constexpr float least_shared = 0.25f;     // relative to the smaller box's area

struct Candidate {
  std::size_t mesh;
  const Object* object;
  Bounds box = Bounds::none();
};

Bounds box_of(const Mesh& mesh) {
  Bounds box = Bounds::none();
  for (const glm::vec3& p : mesh.positions) box.extend(Lanes{p.x, p.y, p.z, 0});
  return box;
}

bool overlap_much(const Bounds& a, const Bounds& b) {
  const Bounds both{lanes_max(a.lower, b.lower), lanes_min(a.upper, b.upper)};
  for (int axis = 0; axis < 3; ++axis)
    if (!(both.lower[axis] < both.upper[axis])) return false;
  const Lanes edges = lanes_max(a.upper, b.upper) - lanes_min(a.lower, b.lower);
  const float scale = 1 / std::max({edges[0], edges[1], edges[2], 1e-30f});
  return half_area(both, scale) >= least_shared * std::min(half_area(a, scale), half_area(b, scale));
}

/// Meshes placed by exactly one object, without motion, sorted by transform.
std::vector<Candidate> candidates_of(const SceneDescription& scene) {
  std::vector<std::size_t> placed(scene.meshes.size());
  std::vector<const Object*> object_of(scene.meshes.size());
  for (const Object& object : scene.objects)
    if (const auto* shape = std::get_if<MeshShape>(&object.shape)) {
      const auto mesh = static_cast<std::size_t>(shape->mesh);
      placed[mesh] += object.moves() ? 2 : 1;
      object_of[mesh] = &object;
    }
  std::vector<Candidate> candidates;
  for (std::size_t i = 0; i < placed.size(); ++i)
    if (placed[i] == 1 && !scene.meshes[i].triangles.empty()) candidates.push_back({i, object_of[i]});
  const auto place = [](const Candidate& one) {
    const double* m = &one.object->world_from_object[0][0];
    return std::span<const double, 16>(m, 16);
  };
  std::ranges::stable_sort(candidates, [&](const Candidate& a, const Candidate& b) {
    return std::ranges::lexicographical_compare(place(a), place(b));
  });
  return candidates;
}

/// Disjoint sets of meshes.
class Sets {
 public:
  explicit Sets(std::size_t count) : parent_(count), size_(count, 1) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }
  std::size_t first_of(std::size_t i) const {
    while (parent_[i] != i) i = parent_[i];
    return i;
  }
  void join(std::size_t a, std::size_t b) {
    const std::size_t one = first_of(a), two = first_of(b), first = std::min(one, two),
                      other = std::max(one, two);
    if (first == other || size_[first] + size_[other] > most_sharing) return;
    parent_[other] = first;
    size_[first] += size_[other];
  }

 private:
  std::vector<std::size_t> parent_, size_;
};

/// Joins overlapping meshes with the same transform.
void join_overlapping(std::span<Candidate> same_place, const SceneDescription& scene, Sets& sets) {
  if (same_place.size() < 2) return;
  for (Candidate& one : same_place) one.box = box_of(scene.meshes[one.mesh]);
  std::ranges::stable_sort(same_place, {}, [](const Candidate& one) { return float(one.box.lower[0]); });
  for (std::size_t i = 0; i < same_place.size(); ++i)
    for (std::size_t k = i + 1; k < same_place.size(); ++k) {
      if (!(same_place[k].box.lower[0] < same_place[i].box.upper[0])) break;
      if (overlap_much(same_place[i].box, same_place[k].box))
        sets.join(same_place[i].mesh, same_place[k].mesh);
    }
}

}  // namespace

std::vector<std::vector<std::size_t>> mesh_groups(const SceneDescription& scene) {
  Sets sets(scene.meshes.size());
  std::vector<Candidate> candidates = candidates_of(scene);
  for (auto first = candidates.begin(); first != candidates.end();) {
    const auto last = std::find_if(first, candidates.end(), [&](const Candidate& one) {
      return one.object->world_from_object != first->object->world_from_object;
    });
    join_overlapping({first, last}, scene, sets);
    first = last;
  }
  std::vector<bool> used(scene.meshes.size());
  for (const Object& object : scene.objects)
    if (const auto* shape = std::get_if<MeshShape>(&object.shape)) used[std::size_t(shape->mesh)] = true;
  std::vector<std::vector<std::size_t>> groups;
  std::vector<std::size_t> group_of(scene.meshes.size());
  for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
    if (!used[i]) continue;
    const std::size_t first = sets.first_of(i);
    if (first == i) {
      group_of[i] = groups.size();
      groups.push_back({i});
    } else
      groups[group_of[first]].push_back(i);
  }
  return groups;
}

std::vector<const Mesh*> placed_meshes(const SceneDescription& scene) {
  std::vector<const Mesh*> meshes(scene.meshes.size());
  for (const Object& object : scene.objects)
    if (const auto* shape = std::get_if<MeshShape>(&object.shape)) {
      const auto mesh = static_cast<std::size_t>(shape->mesh);
      meshes[mesh] = &scene.meshes[mesh];
    }
  return meshes;
}

}  // namespace sundog
