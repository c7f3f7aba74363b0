// Intersects triangles (Moeller and Trumbore 1997) and the solids of bench/plain in double precision.
#include "bench/rays/exact_tracer.h"

#include <algorithm>
#include <functional>

#include "bench/plain/solids.h"

namespace sundog {
namespace {

using glm::dvec3;

/// Moeller and Trumbore 1997, both sides.
void cross_block(const TriangleBlock& block, const HostRay& ray, std::vector<HostHit>& hits) {
  for (std::size_t i = 0; i < 8; ++i) {
    if (block.prim[i] == NO_PRIM) continue;
    const dvec3 v0(block.v0_x[i], block.v0_y[i], block.v0_z[i]);
    const dvec3 e1 = dvec3(block.v1_x[i], block.v1_y[i], block.v1_z[i]) - v0,
                e2 = dvec3(block.v2_x[i], block.v2_y[i], block.v2_z[i]) - v0;
    const dvec3 p = glm::cross(ray.direction, e2);
    const double det = glm::dot(e1, p);
    if (det == 0) continue;
    const dvec3 s = ray.origin - v0, q = glm::cross(s, e1);
    HostHit hit;
    hit.u = glm::dot(s, p) / det;
    hit.v = glm::dot(ray.direction, q) / det;
    hit.t = glm::dot(e2, q) / det;
    hit.prim = block.prim[i];
    hit.ng = glm::cross(e1, e2);
    if (hit.u >= 0 && hit.v >= 0 && hit.u + hit.v <= 1 && hit.t > ray.t_min && hit.t < ray.t_max)
      hits.push_back(hit);
  }
}

/// A box test that never misses a touched box: NaN (0 / 0) counts as inside.
bool crosses(const Bvh8Node& node, u32 slot, const HostRay& ray) {
  const double lower[3] = {node.lower_x[slot], node.lower_y[slot], node.lower_z[slot]};
  const double upper[3] = {node.upper_x[slot], node.upper_y[slot], node.upper_z[slot]};
  double near = ray.t_min, far = ray.t_max;
  for (int axis = 0; axis < 3; ++axis) {
    const double scale = std::max(std::abs(lower[axis]), std::abs(upper[axis])) * 1e-12;
    const double a = (lower[axis] - scale - ray.origin[axis]) / ray.direction[axis];
    const double b = (upper[axis] + scale - ray.origin[axis]) / ray.direction[axis];
    if (std::min(a, b) > near) near = std::min(a, b);
    if (std::max(a, b) < far) far = std::max(a, b);
  }
  return near <= far;
}

using Enter = std::function<bool(const Bvh8Node&, u32 slot)>;

void visit_leaves(const CompiledScene& scene, u32 word, const Enter& enter,
                  const std::function<void(u32)>& item) {
  if (word & BVH_LEAF) {
    const u32 first = word & BVH_FIRST_MASK;
    for (u32 i = 0; i <= (word >> BVH_LEAF_SHIFT & BVH_LEAF_COUNT_MASK); ++i) item(first + i);
    return;
  }
  const Bvh8Node& node = scene.nodes.at(word);
  for (u32 slot = 0; slot < BVH_WIDTH; ++slot)
    if (node.valid >> slot & 1u && enter(node, slot)) visit_leaves(scene, node.child[slot], enter, item);
}

std::vector<HostHit> cross_instance(const CompiledScene& scene, u32 index, const HostRay& world_ray,
                                    bool all) {
  const Instance& instance = scene.instances.at(index);
  const HostRay ray = object_ray(instance, world_ray);
  std::vector<HostHit> hits;
  if (instance.shape == SHAPE_MESH) {
    const Enter enter = [&](const Bvh8Node& node, u32 slot) { return all || crosses(node, slot, ray); };
    visit_leaves(scene, instance.root, enter,
                 [&](u32 block) { cross_block(scene.blocks.at(block), ray, hits); });
    std::erase_if(hits, [&](const HostHit& hit) {  // of other instances that share the BVH
      return hit.prim < instance.first_prim || instance_of_triangle(scene, index, hit.prim) != index;
    });
  } else {
    for (const auto& [t, ng] : plain::solid_crossings(
             {instance.shape, instance.parameters, scene.profiles.rows()}, ray.origin, ray.direction))
      if (t > ray.t_min && t < ray.t_max) {
        HostHit hit;
        hit.t = t;
        hit.ng = ng;
        hits.push_back(hit);
      }
  }
  for (HostHit& hit : hits) hit.instance = index;
  std::sort(hits.begin(), hits.end(), [](const auto& a, const auto& b) { return a.t < b.t; });
  return hits;
}

struct Nearest {
  std::optional<HostHit> hit;
  void offer(const std::vector<HostHit>& hits) {
    if (!hits.empty() && (!hit || hits[0].t < hit->t)) hit = hits[0];
  }
};

}  // namespace

HostRay object_ray(const Instance& instance, const HostRay& ray) {
  HostRay result = ray;
  for (int row = 0; row < 3; ++row) {
    const float4& m = instance.object_from_world[row];
    const dvec3 linear(m.x, m.y, m.z);
    result.origin[row] = glm::dot(linear, ray.origin) + double(m.w);
    result.direction[row] = glm::dot(linear, ray.direction);
  }
  return result;
}

std::optional<HostHit> trace_host(const CompiledScene& scene, const HostRay& ray) {
  Nearest nearest;
  const Enter enter = [&](const Bvh8Node& node, u32 slot) { return crosses(node, slot, ray); };
  const auto offer = [&](u32 index) {
    nearest.offer(cross_instance(scene, index, ray, false));
    for (; scene.instances[index].flags & INSTANCE_SHARES; ++index)
      nearest.offer(cross_instance(scene, index + 1, ray, false));
  };
  if (scene.info.bounded_count > 0) visit_leaves(scene, scene.info.tlas_root, enter, offer);
  for (u32 i = scene.info.bounded_count; i < scene.info.instance_count; ++i) offer(i);
  return nearest.hit;
}

std::vector<HostHit> crossings(const CompiledScene& scene, u32 instance, const HostRay& ray) {
  return cross_instance(scene, instance, ray, true);
}

std::optional<HostHit> trace_instance(const CompiledScene& scene, u32 instance, const HostRay& ray) {
  Nearest nearest;
  nearest.offer(cross_instance(scene, instance, ray, false));
  return nearest.hit;
}

}  // namespace sundog
