// The work of rays, counted: by hand for a scene of two triangles.
#include "bench/roofline/ray_work.h"
#include "catch.h"
#include "test_meshes.h"

using namespace sundog;

namespace {

RaySet one_ray(float x, bool any) { return {"one", any, false, {Ray{x, 0.25f, 5, 0, 0, 0, -1, 100}}}; }

}  // namespace

TEST_CASE("the work of a ray is that of the nodes, blocks and instances it comes to") {
  Mesh mesh;
  for (const glm::vec3& corner :
       {glm::vec3(0, 0, 0), glm::vec3(1, 0, 0), glm::vec3(0, 1, 0), glm::vec3(1, 1, 0)})
    mesh.positions.push_back(corner);
  mesh.triangles.push_back({0, 1, 2});
  mesh.triangles.push_back({1, 3, 2});
  const CompiledScene scene = compile(scene_of(mesh));
  const RayWork wide = ray_work(scene, one_ray(0.25f, false), false);
  CHECK(wide.instances == 1);
  CHECK(wide.blocks == 1);
  // The ray's start, eight boxes a node, the instance's transform with its own start, eight triangles.
  CHECK(wide.operations == 43 + 96 * wide.nodes + 33 + 43 + 8 * 49);
  CHECK(wide.bytes == 32 + 32 + 256 * wide.nodes + 128 + 320);
  CHECK(wide.least_bytes == wide.bytes);
  // One lane tests only the triangles that are there.
  const RayWork compact = ray_work(scene, one_ray(0.25f, true), true);
  CHECK(compact.bytes == 32 + 4 + 96 * compact.nodes + 128 + 80);
  // Twice the same ray: entries of tables come from memory once.
  RaySet twice = one_ray(0.25f, false);
  twice.rays.push_back(twice.rays[0]);
  CHECK(ray_work(scene, twice, false).bytes == wide.bytes);
  CHECK(2 * (ray_work(scene, twice, false).least_bytes - 64) == wide.bytes - 64);
}
