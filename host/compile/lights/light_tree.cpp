// Halves the lights along the longest axis of their centres, left child first, and replaces their light rays
// by rays to chosen lights.
#include "compile/lights/light_tree.h"

#include <algorithm>
#include <span>

#include "scene/integrators.h"
#include "scene/kinds.h"
#include "scene/lamps.h"

namespace sundog {
namespace {

struct Lamp {
  glm::vec3 lower, upper;
  float power;
  u32 light;
  glm::vec3 middle() const { return 0.5f * (lower + upper); }
};

bool has_extent(const Light& light) {
  if (light.kind == LIGHT_TRIANGLE) return light.direction.w > 0 && light.color != float4{};
  return light.kind < LIGHT_KINDS && facts_of_kind(light.kind).has_extent();
}

Lamp lamp_of(const Light& light, u32 index) {
  const LampBounds bounds = lamp_bounds(light);
  return {bounds.lower, bounds.upper, bounds.power, index};
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

/// Appends the subtree, split in halves along the longest axis of the lamps' centres. The left child follows
/// its parent.
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

LightTree make_light_tree(const RenderSettings& settings, const std::vector<Light>& lights,
                          SharedTable<LightRay> rays) {
  LightTree tree;
  tree.light_rays = std::move(rays);
  const bool chooses_one = !integrator_of(settings.integrator).branches;
  std::vector<Lamp> lamps;
  for (u32 i = 0; i < lights.size(); ++i)
    if (has_extent(lights[i])) lamps.push_back(lamp_of(lights[i], i));
  const bool triangles =
      std::ranges::any_of(lights, [](const Light& light) { return light.kind == LIGHT_TRIANGLE; });
  const bool chooses = settings.light_samples > 0 || chooses_one || triangles;
  // General kernels request the path to each light, even if there is nothing to choose.
  std::vector<u32> leaves(lights.size());
  if (chooses && !lamps.empty() && (lamps.size() > 1 || triangles)) {
    append(lamps, tree.light_nodes.edit());
    for (u32 node = 0; node < tree.light_nodes.size(); ++node)
      if (const u32 next = tree.light_nodes[node].next; next & LIGHT_LEAF) leaves[next & ~LIGHT_LEAF] = node;
    std::erase_if(tree.light_rays.edit(), [&](const LightRay& ray) { return has_extent(lights[ray.light]); });
    const auto count = static_cast<u32>(std::max(settings.light_samples, 1));
    for (u32 ray = 0; ray < count; ++ray) tree.light_rays.push_back({LIGHT_CHOSEN, ray, count, 0});
  }
  tree.light_leaves = std::move(leaves);
  if (chooses_one) std::erase_if(tree.light_rays.edit(), [](const LightRay& ray) { return ray.ray > 0; });
  return tree;
}

}  // namespace sundog
