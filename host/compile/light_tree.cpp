// See light_tree.h.
#include "compile/light_tree.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "scene/integrators.h"

namespace sundog {
namespace {

struct Lamp {
  glm::vec3 lower, upper;
  float power;
  u32 light;
  glm::vec3 middle() const { return 0.5f * (lower + upper); }
};

glm::vec3 xyz(const float4& v) { return {v.x, v.y, v.z}; }

bool has_extent(const Light& light) {
  if (light.kind == LIGHT_TRIANGLE) return light.direction.w > 0 && light.color != float4{};
  return light.kind >= LIGHT_RECTANGLE && light.kind < LIGHT_KINDS;
}

Lamp lamp_of(const Light& light, u32 index) {
  const glm::vec3 p = xyz(light.position), u = glm::abs(xyz(light.edge_u)), v = glm::abs(xyz(light.edge_v));
  const float luminance = 0.2126f * light.color.x + 0.7152f * light.color.y + 0.0722f * light.color.z;
  const float radius = light.edge_u.w;
  switch (light.kind) {
    case LIGHT_SPHERE:
      return {p - radius, p + radius, luminance * 4 * std::numbers::pi_v<float> * radius * radius, index};
    case LIGHT_TRIANGLE: {
      const glm::vec3 a = xyz(light.edge_u), b = xyz(light.edge_v), none(0);
      return {p + glm::min(none, glm::min(a, b)), p + glm::max(none, glm::max(a, b)),
              luminance * light.direction.w, index};
    }
    case LIGHT_DISK:
      return {p - u - v, p + u + v, luminance * light.direction.w, index};
    default: {
      const glm::vec3 a = xyz(light.edge_u), b = xyz(light.edge_v);
      return {p + glm::min(a, glm::vec3(0)) + glm::min(b, glm::vec3(0)),
              p + glm::max(a, glm::vec3(0)) + glm::max(b, glm::vec3(0)), luminance * light.direction.w,
              index};
    }
  }
}

LightNode node_over(std::span<const Lamp> lamps) {
  glm::vec3 lower = lamps[0].lower, upper = lamps[0].upper;
  double power = 0;
  for (const Lamp& lamp : lamps) {
    lower = glm::min(lower, lamp.lower);
    upper = glm::max(upper, lamp.upper);
    power += double(lamp.power);
  }
  return {{lower.x, lower.y, lower.z}, static_cast<float>(power), {upper.x, upper.y, upper.z}, 0};
}

/// Appends the subtree, halved across the longest axis of the lamps' middles. The left child follows its
/// parent.
void append(std::span<Lamp> lamps, std::vector<LightNode>& nodes) {
  const std::size_t at = nodes.size();
  nodes.push_back(node_over(lamps));
  if (lamps.size() == 1) {
    nodes[at].next = LIGHT_LEAF | lamps[0].light;
    return;
  }
  glm::vec3 lower = lamps[0].middle(), upper = lower;
  for (const Lamp& lamp : lamps)
    lower = glm::min(lower, lamp.middle()), upper = glm::max(upper, lamp.middle());
  const glm::vec3 size = upper - lower;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const std::size_t half = lamps.size() / 2;
  std::nth_element(lamps.begin(), lamps.begin() + static_cast<std::ptrdiff_t>(half), lamps.end(),
                   [&](const Lamp& a, const Lamp& b) {
                     const float x = a.middle()[axis], y = b.middle()[axis];
                     return x != y ? x < y : a.light < b.light;
                   });
  append(lamps.first(half), nodes);
  nodes[at].next = static_cast<u32>(nodes.size());
  append(lamps.subspan(half), nodes);
}

}  // namespace

void add_light_tree(const SceneDescription& scene, CompiledScene& out) {
  std::vector<Lamp> lamps;
  for (u32 i = 0; i < out.lights.size(); ++i)
    if (has_extent(out.lights[i])) lamps.push_back(lamp_of(out.lights[i], i));
  const bool triangles =
      std::ranges::any_of(out.lights, [](const Light& light) { return light.kind == LIGHT_TRIANGLE; });
  const bool chooses = scene.render.light_samples > 0 || traces_paths(scene.render.integrator) || triangles;
  if (!chooses || lamps.empty() || (lamps.size() == 1 && !triangles)) return;
  append(lamps, out.light_nodes.edit());
  std::vector<u32> leaves(out.lights.size());
  for (u32 node = 0; node < out.light_nodes.size(); ++node)
    if (const u32 next = out.light_nodes[node].next; next & LIGHT_LEAF) leaves[next & ~LIGHT_LEAF] = node;
  out.light_leaves = std::move(leaves);
  std::erase_if(out.light_rays.edit(),
                [&](const LightRay& ray) { return has_extent(out.lights[ray.light]); });
  const auto rays = static_cast<u32>(std::max(scene.render.light_samples, 1));
  for (u32 ray = 0; ray < rays; ++ray) out.light_rays.push_back({LIGHT_CHOSEN, ray, rays, 0});
  out.features.light_tree = true;
}

}  // namespace sundog
