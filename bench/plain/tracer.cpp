// Traverses the two-level BVH child by child, near ones first; intersects triangles by Moeller and Trumbore
// (1997).
#include "bench/plain/tracer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace sundog::plain {
namespace {

using glm::vec3;

struct Walk {
  const CompiledScene& scene;
  bool any = false;
  Ray ray;  // world space; t_max shrinks to the nearest hit
  Hit hit;
  bool found = false;
  Visits* visits = nullptr;

  bool done() const { return any && found; }
};

/// Distance at which the ray enters a child's box; infinite if it misses the box in [t_min, t_max].
float enter_box(const Bvh8Node& node, u32 slot, const Ray& ray, const vec3& reciprocal) {
  const vec3 lower(node.lower_x[slot], node.lower_y[slot], node.lower_z[slot]),
      upper(node.upper_x[slot], node.upper_y[slot], node.upper_z[slot]);
  const vec3 a = (lower - ray.o) * reciprocal, b = (upper - ray.o) * reciprocal;
  const vec3 in = glm::min(a, b), out = glm::max(a, b);
  const float from = std::max(std::max(in.x, in.y), std::max(in.z, ray.t_min));
  const float to = std::min(std::min(out.x, out.y), std::min(out.z, ray.t_max)) * 1.000001f;
  return from <= to ? from : std::numeric_limits<float>::infinity();
}

/// 1 / d without infinities, which would give NaN for boxes that the ray's origin touches.
vec3 safe_reciprocal(const vec3& d) {
  vec3 result;
  for (int i = 0; i < 3; ++i) result[i] = 1 / (std::abs(d[i]) < 1e-18f ? std::copysign(1e-18f, d[i]) : d[i]);
  return result;
}

/// Visits the leaves below `root` that the ray crosses, near ones first.
template <class Leaf>
void walk_tree(Walk& walk, u32 root, Ray& ray, const Leaf& leaf) {
  struct Waiting {
    u32 word;
    float t;
  };
  const vec3 reciprocal = safe_reciprocal(ray.d);
  std::array<Waiting, 512> stack;  // at most seven wait at each level, and trees are not that deep
  std::size_t top = 0;
  stack[top++] = {root, 0};
  while (top > 0 && !walk.done()) {
    const Waiting next = stack[--top];
    if (next.t > ray.t_max) continue;
    if (next.word & BVH_LEAF) {
      const u32 first = next.word & BVH_FIRST_MASK;
      for (u32 i = 0; i <= (next.word >> BVH_LEAF_SHIFT & BVH_LEAF_COUNT_MASK); ++i) leaf(first + i);
      continue;
    }
    const Bvh8Node& node = walk.scene.nodes[next.word];
    if (walk.visits) ++walk.visits->nodes[next.word];
    const std::size_t base = top;
    for (u32 slot = 0; slot < BVH_WIDTH; ++slot) {
      if (!(node.valid >> slot & 1u)) continue;
      const float t = enter_box(node, slot, ray, reciprocal);
      if (std::isinf(t)) continue;
      if (top == stack.size()) throw std::length_error("a BVH is deeper than the plain tracer's stack");
      stack[top++] = {node.child[slot], t};
      for (std::size_t i = top - 1; i > base && stack[i - 1].t < stack[i].t; --i)
        std::swap(stack[i - 1], stack[i]);
    }
  }
}

void cross_block(Walk& walk, const TriangleBlock& block, Ray& ray, u32 instance) {
  for (std::size_t i = 0; i < BVH_WIDTH && block.prim[i] != NO_PRIM; ++i) {
    const vec3 v0(block.v0_x[i], block.v0_y[i], block.v0_z[i]);
    const vec3 e1 = vec3(block.v1_x[i], block.v1_y[i], block.v1_z[i]) - v0,
               e2 = vec3(block.v2_x[i], block.v2_y[i], block.v2_z[i]) - v0;
    const vec3 p = glm::cross(ray.d, e2);
    const float det = glm::dot(e1, p);
    if (det == 0) continue;
    const vec3 s = ray.o - v0;
    const float u = glm::dot(s, p) / det;
    if (u < 0 || u > 1) continue;
    const vec3 q = glm::cross(s, e1);
    const float v = glm::dot(ray.d, q) / det;
    if (v < 0 || u + v > 1) continue;
    const float t = glm::dot(e2, q) / det;
    if (!(t > ray.t_min && t <= ray.t_max)) continue;
    ray.t_max = t;
    walk.hit = {t,
                u,
                v,
                block.prim[i],
                instance_of_triangle(walk.scene, instance, block.prim[i]),
                glm::cross(e1, e2)};
    walk.found = true;
  }
}

void cross_instance(Walk& walk, u32 index) {
  const Instance& instance = walk.scene.instances[index];
  if (walk.visits) ++walk.visits->instances[index];
  Ray ray{object_point(instance, walk.ray.o), object_vector(instance, walk.ray.d), walk.ray.t_min,
          walk.ray.t_max};
  if (instance.shape == SHAPE_MESH) {
    walk_tree(walk, instance.root, ray, [&](u32 block) {
      if (walk.visits) ++walk.visits->blocks[block];
      cross_block(walk, walk.scene.blocks[block], ray, index);
    });
    walk.ray.t_max = ray.t_max;
    return;
  }
  SolidHit solid;
  if (!closest_in_solid({instance.shape, instance.parameters, walk.scene.profiles.rows()}, ray, solid))
    return;
  walk.ray.t_max = solid.t;
  walk.hit = {solid.t, 0, 0, 0, index, solid.ng};
  walk.found = true;
}

void cross_scene(Walk& walk) {
  const SceneInfo& info = walk.scene.info;
  if (info.bounded_count > 0)
    walk_tree(walk, info.tlas_root, walk.ray, [&](u32 index) { cross_instance(walk, index); });
  for (u32 i = info.bounded_count; i < info.instance_count && !walk.done(); ++i) cross_instance(walk, i);
}

}  // namespace

glm::vec3 object_point(const Instance& instance, const vec3& p) {
  const float4* m = instance.object_from_world;
  return object_vector(instance, p) + vec3(m[0].w, m[1].w, m[2].w);
}

glm::vec3 object_vector(const Instance& instance, const vec3& d) {
  vec3 result;
  for (int row = 0; row < 3; ++row) {
    const float4& m = instance.object_from_world[row];
    result[row] = m.x * d.x + m.y * d.y + m.z * d.z;
  }
  return result;
}

glm::vec3 world_normal(const Instance& instance, const vec3& n) {
  const float4* m = instance.object_from_world;
  return vec3(m[0].x, m[0].y, m[0].z) * n.x + vec3(m[1].x, m[1].y, m[1].z) * n.y +
         vec3(m[2].x, m[2].y, m[2].z) * n.z;
}

Visits::Visits(const CompiledScene& scene)
    : nodes(scene.nodes.size()), blocks(scene.blocks.size()), instances(scene.instances.size()) {}

bool closest_hit(const CompiledScene& scene, const Ray& ray, Hit& hit, Visits* visits) {
  Walk walk{scene, false, ray, {}, false, visits};
  cross_scene(walk);
  hit = walk.hit;
  return walk.found;
}

bool any_hit(const CompiledScene& scene, const Ray& ray, Visits* visits) {
  Walk walk{scene, true, ray, {}, false, visits};
  cross_scene(walk);
  return walk.found;
}

}  // namespace sundog::plain
