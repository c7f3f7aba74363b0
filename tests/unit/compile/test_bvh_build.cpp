// The builder's promises: every triangle once, boxes that hold what is below them, the same bytes at any
// number of threads.
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <atomic>
#include <chrono>
#include <cstring>
#include <limits>
#include <set>
#include <thread>

#include "base/error.h"
#include "brute_force.h"
#include "catch.h"
#include "compile/bvh/wide_bvh.h"
#include "compile/compiled_scene.h"
#include "test_meshes.h"

using namespace sundog;

namespace {

constexpr float inf = std::numeric_limits<float>::infinity();

bool same_bytes(const auto& a, const auto& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0);
}

/// Fails where a box of the subtree sticks out of `outer`, or a slot is not as bvh.h says. Returns the box of
/// what is below.
void check_node(const CompiledScene& scene, u32 index, const Bounds& outer, std::set<u32>& prims) {
  const Bvh8Node& node = scene.nodes.at(index);
  bool ended = false;
  for (u32 slot = 0; slot < BVH_WIDTH; ++slot) {
    const Bounds box = child_bounds(node, slot);
    if (!(node.valid >> slot & 1u)) {
      ended = true;
      CHECK(node.child[slot] == BVH_EMPTY);
      for (int axis = 0; axis < 3; ++axis) CHECK((box.lower[axis] == inf && box.upper[axis] == -inf));
      continue;
    }
    CHECK_FALSE(ended);  // filled slots come first
    for (int axis = 0; axis < 3; ++axis)
      CHECK((box.lower[axis] >= outer.lower[axis] && box.upper[axis] <= outer.upper[axis]));
    if (!(node.child[slot] & BVH_LEAF)) {
      check_node(scene, node.child[slot], box, prims);
      continue;
    }
    for (const u32 item : leaf_items(scene, node.child[slot])) {
      const TriangleBlock& block = scene.blocks.at(item);
      for (std::size_t lane = 0; lane < 8; ++lane) {
        if (block.prim[lane] == NO_PRIM) {
          CHECK((block.v0_x[lane] == 0 && block.v1_x[lane] == 0 && block.v2_x[lane] == 0));
          continue;
        }
        CHECK(prims.insert(block.prim[lane]).second);
        for (const auto* corner : {&block.v0_x, &block.v1_x, &block.v2_x})
          for (int axis = 0; axis < 3; ++axis) {
            const float value = corner[axis][lane];  // the corner's x, y and z arrays follow each other
            CHECK((value >= box.lower[axis] && value <= box.upper[axis]));
          }
      }
    }
  }
}

/// Compiles `mesh` alone and checks the whole tree.
CompiledScene checked(const Mesh& mesh) {
  const std::size_t count = mesh.triangles.size();
  CompiledScene scene = compile(scene_of(mesh));
  std::set<u32> prims;
  const Bounds everything{lanes(-inf), lanes(inf)};
  if (count > 0) {
    REQUIRE(scene.instances.size() == 1);
    check_node(scene, scene.instances[0].root, everything, prims);
  }
  CHECK(prims.size() == count);
  CHECK(scene.triangles.size() == count);
  CHECK(scene.features.bvh_stack <= 2 * stack_limit);
  return scene;
}

/// Compiles with `threads` threads, more than the machine has cores too: an arena takes so many slots, and
/// the workers for them come from the control.
CompiledScene compiled_on(int threads, const SceneDescription& scene) {
  const tbb::global_control allow(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(threads));
  tbb::task_arena arena(threads);
  CompiledScene result;
  arena.execute([&] {
    REQUIRE(tbb::this_task_arena::max_concurrency() == threads);
    result = compile(scene);
  });
  return result;
}

Mesh repeated(const Mesh& one, std::size_t times) {
  Mesh mesh = one;
  for (std::size_t i = 1; i < times; ++i) mesh.triangles.push_back(one.triangles[0]);
  return mesh;
}

}  // namespace

TEST_CASE("every triangle is in the tree once, inside each box above it") {
  for (const std::size_t count : {1u, 2u, 7u, 8u, 9u, 63u, 64u, 65u, 1000u, 20000u}) {
    INFO(count << " triangles");
    checked(random_triangles(count, 0.05f));
  }
  checked(random_triangles(3000, 1.0f));
  checked(bumpy_sphere(100));
}

TEST_CASE("an arena of more threads than cores has so many workers") {
  const tbb::global_control allow(tbb::global_control::max_allowed_parallelism, 8);
  tbb::task_arena arena(8);
  std::atomic<int> inside{0};
  arena.execute([&] {  // each waits for the seven others
    tbb::parallel_for(
        0, 8,
        [&](int) {
          const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(120);
          for (++inside; inside < 8 && std::chrono::steady_clock::now() < end;) std::this_thread::yield();
        },
        tbb::simple_partitioner());
  });
  CHECK(inside == 8);
}

TEST_CASE("the tree is the same bytes for any number of threads") {
  const SceneDescription scene = scene_of(random_triangles(200000, 0.01f));
  const CompiledScene one = compiled_on(1, scene);
  for (const int threads : {2, 3, 8}) {
    const CompiledScene other = compiled_on(threads, scene);
    CHECK(same_bytes(one.nodes, other.nodes));
    CHECK(same_bytes(one.blocks, other.blocks));
    CHECK(same_bytes(one.triangles, other.triangles));
    CHECK(same_bytes(one.vertices, other.vertices));
    CHECK(same_bytes(one.instances, other.instances));
  }
}

TEST_CASE("a mesh without triangles leaves no instance") {
  const CompiledScene scene = checked(Mesh{});
  CHECK(scene.instances.empty());
  CHECK(scene.info.bounded_count == 0);
  CHECK(scene.nodes.at(scene.info.tlas_root).valid == 0);
}

TEST_CASE("a scene without objects compiles") {
  SceneDescription scene;
  scene.media.resize(1);
  const CompiledScene flat = compile(scene);
  CHECK(flat.instances.empty());
  CHECK(flat.info.scene_center == float4{});
}

TEST_CASE("identical triangles end in leaves") {
  Mesh one;
  one.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  one.triangles = {{0, 1, 2}};
  for (const std::size_t count : {8u, 9u, 128u, 129u, 5000u}) checked(repeated(one, count));
}

TEST_CASE("degenerate triangles are kept without harm") {
  Mesh mesh = random_triangles(500, 0.1f);
  for (std::size_t i = 0; i < 500; i += 2) mesh.triangles[i].z = mesh.triangles[i].y = mesh.triangles[i].x;
  checked(mesh);
  Mesh line;
  for (unsigned i = 0; i < 4000; ++i) {
    line.positions.emplace_back(static_cast<float>(i), 0, 0);
    if (i > 0) line.triangles.emplace_back(i - 1, i, i);
  }
  checked(line);
}

TEST_CASE("huge, tiny and flat boxes build a sound tree") {
  for (const float scale : {1e30f, 1e-30f, 1e-38f}) {
    Mesh mesh = random_triangles(2000, 0.1f);
    for (glm::vec3& p : mesh.positions) p *= scale;
    INFO("scale " << scale);
    const CompiledScene scene = checked(mesh);
    if (scale > 1e-35f) CHECK(scene.figures.sah_cost < 50);
  }
  Mesh flat = random_triangles(2000, 0.1f);
  for (glm::vec3& p : flat.positions) p.y = 3;
  CHECK(checked(flat).figures.sah_cost < 50);
  Mesh outlier = random_triangles(2000, 0.1f);
  outlier.positions[0] = {1e30f, 1e30f, 1e30f};
  checked(outlier);
}

TEST_CASE("a lopsided set neither overflows the stack nor makes a deep tree") {
  Mesh mesh;  // each triangle ten times as far out as the one before, many times over
  for (int i = 0; i < 20000; ++i) {
    const float x = std::pow(10.0f, static_cast<float>(i % 70) - 35);
    const auto first = static_cast<unsigned>(mesh.positions.size());
    mesh.positions.values().insert(mesh.positions.values().end(), {{x, 0, 0}, {x, x, 0}, {x, 0, x}});
    mesh.triangles.emplace_back(first, first + 1, first + 2);
  }
  checked(mesh);
}

TEST_CASE("a vertex that is not finite is an error that names mesh and vertex") {
  for (const float bad : {inf, -inf, std::numeric_limits<float>::quiet_NaN(), 1e37f}) {
    SceneDescription scene = scene_of(bumpy_sphere(4));
    scene.meshes[0].positions[17].y = bad;
    try {
      compile(scene);
      FAIL("compiled");
    } catch (const SceneError& error) {
      CHECK(error.place == "/objects/0");
      CHECK(error.reason.find("\"bumpy\"") != std::string::npos);
      CHECK(error.reason.find("vertex 17") != std::string::npos);
    }
  }
}

TEST_CASE("a triangle that names no vertex is an error") {
  SceneDescription scene = scene_of(bumpy_sphere(4));
  scene.meshes[0].triangles[3].y = 100000;
  CHECK_THROWS_AS(compile(scene), SceneError);
}

TEST_CASE("blocks are well filled and the tree is cheap on a scanned-like model") {
  const CompiledScene scene = compile(scene_of(bumpy_sphere(120)));
  CHECK(scene.figures.mean_block_fill > 5);
  CHECK(scene.figures.sah_cost < 16);
  CHECK(scene.figures.triangles == 2 * 2 * 120 * 119u);
}

TEST_CASE("a mesh placed twice is built once") {
  SceneDescription scene = scene_of(bumpy_sphere(20));
  const CompiledScene once = compile(scene);
  scene.objects.push_back(scene.objects[0]);
  scene.objects[1].world_from_object[3] = {5, 0, 0, 1};
  const CompiledScene twice = compile(scene);
  CHECK(twice.blocks.size() == once.blocks.size());
  CHECK(twice.instances.size() == 2);
  CHECK(twice.instances[0].root == twice.instances[1].root);
}

TEST_CASE("cut triangles make long thin ones cheaper, within their room, the same at any number of threads") {
  SceneDescription scene = scene_of(random_triangles(20000, 0.01f));
  for (unsigned i = 0; i < 20000; i += 40) {  // needles through half the scene
    glm::vec3& tip = scene.meshes[0].positions[3 * i];
    tip = -tip;
  }
  const CompiledScene whole = compile(scene);
  scene.render.spatial_splits = true;
  std::vector<CompiledScene> cut;
  for (const int threads : {1, 2, 3, 8}) {
    cut.push_back(compiled_on(threads, scene));
    CHECK(same_bytes(cut[0].nodes, cut.back().nodes));
    CHECK(same_bytes(cut[0].blocks, cut.back().blocks));
  }
  CHECK(cut[0].figures.sah_cost < 0.9 * whole.figures.sah_cost);
  std::set<u32> prims;
  std::size_t entries = 0;
  for (const TriangleBlock& block : cut[0].blocks)
    for (const u32 prim : block.prim)
      if (prim != NO_PRIM) {
        prims.insert(prim);
        ++entries;
      }
  CHECK(prims.size() == 20000);
  CHECK(entries > 20000);
  CHECK(entries <= 26000);
}
