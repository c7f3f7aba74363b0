// The host gives the tracers' stacks as much room as rays need that cross every box.
#include "render/device/kernel_config.h"

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>

#include "catch.h"
#include "scenes.h"
#include "test_meshes.h"

using namespace sundog;
using glm::dmat4;
using glm::dvec3;

namespace {

/// Entries that wait at most while a ray goes through a tree and crosses all boxes. In the compact tracer a
/// node's other children are one entry, and so is the rest of a leaf's instances; a mesh keeps the ray in
/// four, a lathe ray and hit in seven. In the wide one each child is an entry, and the rest has room of its
/// own.
struct Stack {
  const CompiledScene& scene;
  bool compact;
  std::size_t most = 0;

  void node(u32 index, std::size_t top, bool in_mesh) {
    const Bvh8Node& node = scene.nodes[index];
    std::size_t children = 0;
    while (children < BVH_WIDTH && (node.valid >> children & 1u)) ++children;
    for (std::size_t slot = 0; slot < children; ++slot) {  // the last child leaves nothing waiting
      const std::size_t others = children - 1 - slot;
      word(node.child[slot], top + (compact ? std::min<std::size_t>(others, 1) : others), in_mesh);
    }
  }
  void word(u32 word, std::size_t top, bool in_mesh) {
    most = std::max(most, top);
    if (!(word & BVH_LEAF)) return node(word, top, in_mesh);
    if (in_mesh) return;
    const u32 first = word & BVH_FIRST_MASK, more = word >> BVH_LEAF_SHIFT & BVH_LEAF_COUNT_MASK;
    for (u32 i = 0; i <= more; ++i) {
      const Instance& instance = scene.instances[first + i];
      const std::size_t left = top + (compact ? std::min(more - i, 1u) : 0);
      if (instance.shape == SHAPE_MESH)
        this->word(instance.root, left + (compact ? 4 : 0), true);
      else
        most = std::max(most, left + (compact && instance.shape == SHAPE_LATHE ? 7 : 0));
    }
  }
};

/// Entries that are wanted and those that there are.
void check_room(const SceneDescription& scene) {
  CompiledScene flat = compile(scene);
  REQUIRE(flat.info.bounded_count > 0);
  for (const Tracer tracer : {Tracer::compact, Tracer::wide}) {
    flat.tracer = tracer;
    Stack stack{flat, tracer == Tracer::compact};
    stack.word(flat.info.tlas_root, 0, false);
    const KernelNumbers numbers = make_kernel_config(flat, DeviceInfo()).numbers;
    CAPTURE(stack.compact, stack.most);
    CHECK(stack.most > 0);
    const std::size_t room = numbers.at(stack.compact ? "BVH_LEVELS" : "BVH_STACK");
    CHECK(stack.most <= room);
    if (stack.compact) CHECK(room <= stack.most + 6);  // each entry costs memory
  }
}

SceneDescription with_material() {
  SceneDescription scene = scenes::line_of_sight({0, 0, 9}, {0, 0, 0});
  scenes::add_white(scene);
  return scene;
}

void add_row(SceneDescription& scene, const Shape& shape, int count) {
  for (int i = 0; i < count; ++i)
    scenes::place(scene, shape, 0, glm::translate(dmat4(1), dvec3(2.5 * i, i % 7, i % 3)));
}

}  // namespace

TEST_CASE("a ray that crosses every box has room on the tracers' stacks") {
  for (const int rings : {3, 12, 96}) {
    SceneDescription scene = with_material();
    scene.meshes = {bumpy_sphere(rings), random_triangles(500, 0.3f)};
    for (const int copies : {1, 2, 40}) {
      CAPTURE(rings, copies);
      add_row(scene, MeshShape{0}, copies);
      check_room(scene);
      SceneDescription more = scene;
      add_row(more, MeshShape{1}, 3);
      add_row(more, SphereShape{1}, 30);
      check_room(more);
      add_row(more, LatheShape{}, 5);
      check_room(more);
    }
  }
  SceneDescription solids = with_material();
  add_row(solids, SphereShape{0.5}, 200);
  check_room(solids);
  add_row(solids, LatheShape{}, 30);
  check_room(solids);
}
