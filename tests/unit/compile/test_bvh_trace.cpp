// Rays through the flattened tables find what a search without the BVH finds.
#include <random>
#include <set>

#include "brute_force.h"
#include "catch.h"
#include "every_kind.h"
#include "test_meshes.h"

using namespace sundog;
using glm::dvec3;

namespace {

double uniform(std::mt19937& random) { return static_cast<double>(random()) * 0x1p-31 - 1; }

dvec3 point(std::mt19937& random) {
  const double x = uniform(random), y = uniform(random), z = uniform(random);
  return {x, y, z};
}

/// Random, axis-parallel, and aimed at vertices of the mesh.
std::vector<HostRay> test_rays(const SceneDescription& scene, int count) {
  std::mt19937 random(7);
  std::vector<HostRay> rays;
  for (int i = 0; i < count; ++i) {
    HostRay ray{3.0 * point(random), point(random)};
    if (i % 4 == 1) {
      ray.direction = dvec3(0);
      ray.direction[i / 4 % 3] = i % 8 < 4 ? 1 : -1;
    } else if (i % 4 == 2 && !scene.meshes.empty()) {
      const auto& positions = scene.meshes[0].positions;
      ray.direction = dvec3(positions[random() % positions.size()]) - ray.origin;
    } else if (i % 4 == 3) {
      ray.origin = 0.5 * point(random);
      ray.direction = point(random) - ray.origin;
    }
    rays.push_back(ray);
  }
  return rays;
}

/// Number of hits; checks that BVH and brute force agree on every ray.
int check_agreement(const SceneDescription& description, int count) {
  const CompiledScene scene = compile(description);
  int hits = 0;
  for (const HostRay& ray : test_rays(description, count)) {
    const auto expected = trace_brute_force(scene, ray), found = trace_host(scene, ray);
    REQUIRE(found.has_value() == expected.has_value());
    if (!found) continue;
    ++hits;
    CHECK(found->t == expected->t);
  }
  return hits;
}

dmat4 some_transform(unsigned seed) {
  std::mt19937 random(seed);
  dmat4 m(1);
  for (int column = 0; column < 3; ++column) m[column] = glm::dvec4(point(random), 0);
  m[3] = glm::dvec4(point(random), 1);
  return m;
}

}  // namespace

TEST_CASE("the mesh BVH finds the nearest triangle") {
  CHECK(check_agreement(scene_of(random_triangles(3000, 0.1f)), 600) > 200);
  CHECK(check_agreement(scene_of(random_triangles(300, 1.0f)), 600) > 300);
  CHECK(check_agreement(scene_of(bumpy_sphere(25)), 600) > 200);
}

TEST_CASE("a mesh BVH with cut triangles finds the nearest too") {
  for (const float size : {0.1f, 0.7f, 3.0f}) {
    SceneDescription scene = scene_of(random_triangles(1000, size));
    scene.render.spatial_splits = true;
    CHECK(check_agreement(scene, 1000) > 200);
  }
}

TEST_CASE("the scene BVH finds the nearest of many instances") {
  SceneDescription scene = scene_of(bumpy_sphere(12));
  const std::vector<Shape> shapes =
      with_every_solid({SphereShape{0.5}, BoxShape{{0.2, 0.4, 0.6}}, CylinderShape{0.3, 0.7, true},
                        ConeShape{0.5, 0.1, 0.4, true}, DiskShape{0.8, 0.2}, RectangleShape{{0.7, 0.5}},
                        TorusShape{0.6, 0.2}, RoundBoxShape{{0.4, 0.5, 0.6}, 0.1}, MeshShape{0}});
  for (unsigned i = 0; i < 40; ++i) {
    Object object;
    object.shape = shapes[i % shapes.size()];
    object.material = 0;
    object.world_from_object = some_transform(i);
    scene.objects.push_back(object);
  }
  CHECK(check_agreement(scene, 400) > 200);
  Object plane;
  plane.shape = PlaneShape{};
  plane.material = 0;
  plane.world_from_object[3].y = -1;
  scene.objects.insert(scene.objects.begin(), plane);
  CHECK(check_agreement(scene, 400) > 250);
}

TEST_CASE("a thin solid that stands askew is in several leaves of the scene BVH, and found as before") {
  const auto rods = [](bool askew) {
    SceneDescription scene = scene_of(bumpy_sphere(3));
    scene.meshes.clear();
    scene.objects.clear();
    for (unsigned i = 0; i < 40; ++i) {
      Object object;
      if (i % 2)
        object.shape = CylinderShape{0.02, 1.5, true};
      else
        object.shape = BoxShape{{1.0, 0.03, 0.02}};
      object.material = 0;
      if (askew)
        object.world_from_object = some_transform(i);
      else
        object.world_from_object[3] = some_transform(i)[3];
      scene.objects.push_back(object);
    }
    return scene;
  };
  const auto leaves = [](const SceneDescription& description) {
    const CompiledScene scene = compile(description);
    CHECK(scene.instances.size() == 40);
    const std::vector<u32> items = leaf_items(scene, scene.info.tlas_root);
    CHECK(std::set<u32>(items.begin(), items.end()).size() == 40);
    return items.size();
  };
  CHECK(leaves(rods(false)) == 40);
  CHECK(leaves(rods(true)) > 80);
  CHECK(check_agreement(rods(true), 20000) > 100);
}
