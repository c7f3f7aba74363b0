// Traces rays through a compiled scene in plain scalar C++.
#pragma once
#include <vector>

#include "bench/plain/solids.h"
#include "compile/compiled_scene.h"

namespace sundog::plain {

struct Hit {
  float t = 0, u = 0, v = 0;  // u, v barycentric, of triangles
  u32 prim = 0, instance = 0;
  glm::vec3 ng{0};  // object space, outward, not normalised
};

/// How often rays visited each node, triangle block and instance of a scene.
struct Visits {
  std::vector<u32> nodes, blocks, instances;
  explicit Visits(const CompiledScene& scene);
};

/// Finds the nearest hit in (t_min, t_max]; false: none. Counts in `visits` unless null.
bool closest_hit(const CompiledScene& scene, const Ray& ray, Hit& hit, Visits* visits = nullptr);

/// Whether there is any hit in (t_min, t_max].
bool any_hit(const CompiledScene& scene, const Ray& ray, Visits* visits = nullptr);

glm::vec3 object_point(const Instance& instance, const glm::vec3& p);

glm::vec3 object_vector(const Instance& instance, const glm::vec3& d);

/// To world space, not normalised.
glm::vec3 world_normal(const Instance& instance, const glm::vec3& n);

}  // namespace sundog::plain
