// Which meshes share a BVH, and that rays through it find each mesh's own triangles.
#include "compile/bvh/mesh_groups.h"

#include <glm/gtc/matrix_transform.hpp>

#include "brute_force.h"
#include "catch.h"
#include "compile/scene_compiler.h"
#include "scenes.h"
#include "test_meshes.h"

using namespace sundog;
using glm::dvec3;

namespace {

Mesh ball(float radius, glm::vec3 center = glm::vec3(0)) {
  Mesh mesh = bumpy_sphere(8);
  for (glm::vec3& p : mesh.positions) p = center + radius * p;
  return mesh;
}

/// Balls about one point, each placed once, and one beside them.
SceneDescription balls() {
  SceneDescription scene = scene_of(ball(1));
  for (const Mesh& mesh : {ball(0.7f), ball(0.4f), ball(1, {5, 0, 0})}) {
    scene.meshes.push_back(mesh);
    scenes::place(scene, MeshShape{static_cast<int>(scene.meshes.size()) - 1}, 0);
  }
  return scene;
}

using Groups = std::vector<std::vector<std::size_t>>;

}  // namespace

TEST_CASE("meshes that lie in each other share a BVH") {
  SceneDescription scene = balls();
  CHECK(mesh_groups(scene) == Groups{{0, 1, 2}, {3}});
  SECTION("not one that is placed twice") {
    scenes::place(scene, MeshShape{1}, 0);
    CHECK(mesh_groups(scene) == Groups{{0, 2}, {1}, {3}});
  }
  SECTION("nor one that stands elsewhere") {
    scene.objects[2].world_from_object[3].x = 1e-9;
    CHECK(mesh_groups(scene) == Groups{{0, 1}, {2}, {3}});
  }
  SECTION("nor one that moves") {
    scene.objects[0].moves_by = {0.1, 0, 0};
    CHECK(mesh_groups(scene) == Groups{{0}, {1, 2}, {3}});
  }
  SECTION("nor one that nothing places") {
    scene.objects.erase(scene.objects.begin() + 1);
    CHECK(mesh_groups(scene) == Groups{{0, 2}, {3}});
  }
  SECTION("and at most sixteen do") {
    for (int i = 0; i < 20; ++i) {
      scene.meshes.push_back(ball(0.9f));
      scenes::place(scene, MeshShape{static_cast<int>(scene.meshes.size()) - 1}, 0);
    }
    for (const auto& group : mesh_groups(scene)) CHECK(group.size() <= 16);
  }
}

TEST_CASE("a mesh without a finite corner is named, in a BVH of several too") {
  SceneDescription scene = balls();
  scene.meshes[1].name = "bad";
  SECTION("a vertex too far out") { scene.meshes[1].positions[5].x = 1e37f; }
  SECTION("a vertex that is none") { scene.meshes[1].triangles[5].x = 100000; }
  CHECK_THROWS_WITH(compile(scene), ContainsSubstring("mesh \"bad\": "));
}

TEST_CASE("instances that share a BVH stand in a row, and its hits are each mesh's own") {
  SceneDescription scene = balls();
  std::swap(scene.objects[0], scene.objects[2]);  // the order of objects is not that of triangles
  const CompiledScene flat = compile(scene);
  REQUIRE(flat.instances.size() == 4);
  std::size_t first = 0;
  while (!(flat.instances[first].flags & INSTANCE_SHARES)) ++first;
  const Instance* row = flat.instances.data() + first;
  CHECK((row[1].flags & INSTANCE_SHARES) != 0);
  CHECK((row[2].flags & INSTANCE_SHARES) == 0);
  CHECK((row[0].root == row[1].root && row[1].root == row[2].root));
  CHECK((row[0].first_prim < row[1].first_prim && row[1].first_prim < row[2].first_prim));
  CHECK((row[0].object == 2 && row[1].object == 1 && row[2].object == 0));
  // Along the axis, surfaces of the balls in turn.
  const HostRay ray{{0.01, 0.02, 9}, {0, 0, -1}};
  CHECK(trace_host(flat, ray)->instance == first);
  const double at[] = {trace_instance(flat, u32(first), ray)->t, trace_instance(flat, u32(first) + 1, ray)->t,
                       trace_instance(flat, u32(first) + 2, ray)->t};
  CHECK((at[0] < at[1] && at[1] < at[2]));
  for (u32 i = 0; i < 3; ++i) {
    HostRay behind = ray;
    behind.t_min = at[i] - 1e-6;
    CHECK(trace_host(flat, behind)->instance == first + i);
    CHECK(trace_brute_force(flat, behind)->instance == first + i);
    CHECK(crossings(flat, u32(first) + i, ray).size() == 2);
  }
}

TEST_CASE("an object that leaves the place of others takes its mesh out of their BVH") {
  SceneCompiler compiler;
  SceneDescription scene = balls();
  compiler.compile(scene);
  scene.objects[1].world_from_object = glm::translate(glm::dmat4(1), {0.1, 0, 0});
  const CompiledScene moved = compiler.compile(scene), cold = compile(scene);
  CHECK(moved.nodes.rows().size() == cold.nodes.rows().size());
  CHECK(mesh_groups(scene) == Groups{{0, 2}, {1}, {3}});
  const HostRay ray{{0.01, 0.02, 9}, {0, 0, -1}};
  CHECK(moved.instances[trace_host(moved, ray)->instance].object == 0);
}
