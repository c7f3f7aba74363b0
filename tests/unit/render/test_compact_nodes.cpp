// Compact nodes stand for the wide ones: the same children, boxes that contain theirs and are hardly larger.
#include "render/device/compact_nodes.h"

#include <bit>

#include "catch.h"
#include "compile/compiled_scene.h"
#include "test_meshes.h"

using namespace sundog;

namespace {

double plane(const CompactNode& node, u32 first, u32 axis, u32 slot) {
  const u32 at = first + axis * 8 + slot;
  const double step = std::bit_cast<float>((node.scale >> axis * 8 & 0xFFu) << 23);
  return double(node.origin[axis]) + double(node.quantized[at / 4] >> at % 4 * 8 & 0xFFu) * step;
}

u32 child_word(const CompactNode& node, u32 slot) {
  const u32 child = node.child[slot / 2] >> slot % 2 * 16 & 0xFFFFu;
  if (!(child & COMPACT_LEAF)) return node.first_inner + child;
  return BVH_LEAF | (child >> COMPACT_COUNT_SHIFT & BVH_LEAF_COUNT_MASK) << BVH_LEAF_SHIFT |
         (node.first_leaf + (child & COMPACT_LEAF_DISTANCE));
}

void check(const SceneDescription& description) {
  const CompiledScene scene = compile(description);
  const std::vector<CompactNode> compact = compact_nodes(scene.nodes);
  REQUIRE(compact.size() == scene.nodes.size());
  std::size_t wrong_children = 0, uncovered = 0, wasteful = 0;
  for (std::size_t n = 0; n < compact.size(); ++n) {
    const Bvh8Node& wide = scene.nodes[n];
    REQUIRE(compact[n].scale >> 24 == static_cast<u32>(std::popcount(wide.valid)));
    const float *lower = wide.lower_x, *upper = wide.upper_x;  // axis after axis
    for (u32 slot = 0; slot < compact[n].scale >> 24; ++slot) {
      wrong_children += child_word(compact[n], slot) != wide.child[slot];
      for (u32 axis = 0; axis < 3; ++axis) {
        const double low = plane(compact[n], 0, axis, slot), high = plane(compact[n], 24, axis, slot);
        const double step = std::bit_cast<float>((compact[n].scale >> axis * 8 & 0xFFu) << 23);
        const double l = lower[axis * 8 + slot], u = upper[axis * 8 + slot];
        uncovered += !(low <= l && high >= u);
        wasteful += !(low > l - 1.001 * step && high < u + 1.001 * step);
      }
    }
  }
  CHECK(wrong_children == 0);
  CHECK(uncovered == 0);
  CHECK(wasteful == 0);
}

}  // namespace

TEST_CASE("compact nodes contain the wide nodes' boxes and name the same children") {
  check(scene_of(bumpy_sphere(40)));
  check(scene_of(random_triangles(3000, 0.5f)));
}

TEST_CASE("compact nodes of flat, tiny and huge meshes contain their boxes") {
  for (const float scale : {1e-30f, 1e-3f, 1e12f, 1e30f}) {
    Mesh mesh = random_triangles(500, 0.3f);
    for (auto& p : mesh.positions) p = {p.x * scale, 7.0f, p.z * scale};
    check(scene_of(mesh));
  }
}
