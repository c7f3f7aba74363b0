// Solids become unit shapes under a transform: sizes, bounds and normals as the description says.
#include <random>

#include "base/error.h"
#include "bench/rays/exact_tracer.h"
#include "catch.h"
#include "compile/bvh/wide_bvh.h"
#include "every_kind.h"
#include "test_meshes.h"

using namespace sundog;
using glm::dvec3;

namespace {

SceneDescription scene_with(const Shape& shape, const dmat4& world_from_object = dmat4(1)) {
  SceneDescription scene;
  scene.media.resize(1);
  scene.materials.resize(1);
  Object object;
  object.name = "solid";
  object.place = "/objects/0";
  object.shape = shape;
  object.material = 0;
  object.world_from_object = world_from_object;
  scene.objects.push_back(object);
  return scene;
}

/// Distances to the surfaces that a ray crosses, from `origin` along `direction`.
std::vector<double> distances(const Shape& shape, const dvec3& origin, const dvec3& direction) {
  const CompiledScene scene = compile(scene_with(shape));
  std::vector<double> result;
  for (const HostHit& hit : crossings(scene, 0, {origin, direction})) result.push_back(hit.t);
  return result;
}

void check_distances(const Shape& shape, const dvec3& origin, const dvec3& direction,
                     const std::vector<double>& expected) {
  const auto found = distances(shape, origin, direction);
  REQUIRE(found.size() == expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) CHECK(found[i] == Approx(expected[i]).epsilon(1e-6));
}

Bounds instance_box(const CompiledScene& scene) { return scene.figures.box; }

const std::vector<Shape> bounded_shapes = with_every_solid(
    {SphereShape{2}, BoxShape{{1, 2, 3}}, CylinderShape{0.5, 2, true}, CylinderShape{0.5, 2, false},
     ConeShape{1, 0.25, 2, true}, ConeShape{0, 3, 1, true}, DiskShape{2, 0.5}, RectangleShape{{2, 0.5}},
     TorusShape{2, 0.5}, RoundBoxShape{{1, 2, 3}, 0.5}, MeshShape{0}});

/// Without an inside.
bool is_open(const Shape& shape) {
  return std::visit(
      [](const auto& s) {
        if constexpr (requires { s.open(); }) return s.open();
        return false;
      },
      shape);
}

dmat4 some_transform() {
  dmat4 m(1);
  m[0] = {1.5, 0.3, -0.2, 0};
  m[1] = {-0.4, 0.8, 0.5, 0};
  m[2] = {0.1, -0.7, 2.0, 0};
  m[3] = {10, -20, 30, 1};
  return m;
}

}  // namespace

TEST_CASE("each solid has the size that the description gives it") {
  check_distances(SphereShape{2}, {-5, 0, 0}, {1, 0, 0}, {3, 7});
  check_distances(BoxShape{{1, 2, 3}}, {0, 0, -5}, {0, 0, 1}, {2, 8});
  check_distances(BoxShape{{1, 2, 3}}, {0, 5, 0}, {0, -1, 0}, {3, 7});
  check_distances(CylinderShape{0.5, 2, true}, {0.25, 5, 0}, {0, -1, 0}, {3, 7});
  check_distances(CylinderShape{0.5, 2, true}, {-5, 1, 0}, {1, 0, 0}, {4.5, 5.5});
  check_distances(CylinderShape{0.5, 2, false}, {0.25, 5, 0}, {0, -1, 0}, {});
  check_distances(ConeShape{1, 0, 2, true}, {-5, 0, 0}, {1, 0, 0}, {4.5, 5.5});
  check_distances(ConeShape{1, 0.5, 2, true}, {-5, 2 - 1e-9, 0}, {1, 0, 0}, {4.5, 5.5});
  check_distances(ConeShape{0.5, 2, 1, true}, {1.5, 5, 0}, {0, -1, 0}, {4, 5 - 1.0 / 3});
  check_distances(DiskShape{2, 0.5}, {1, 3, 0}, {0, -1, 0}, {3});
  check_distances(DiskShape{2, 0.5}, {0.25, 3, 0}, {0, -1, 0}, {});
  check_distances(RectangleShape{{2, 0.5}}, {1.9, 3, -0.4}, {0, -1, 0}, {3});
  check_distances(RectangleShape{{2, 0.5}}, {1.9, 3, -0.6}, {0, -1, 0}, {});
  check_distances(TorusShape{2, 0.5}, {-5, 0, 0}, {1, 0, 0}, {2.5, 3.5, 6.5, 7.5});
  check_distances(TorusShape{2, 0.5}, {2, 5, 0}, {0, -1, 0}, {4.5, 5.5});
  check_distances(RoundBoxShape{{1, 2, 3}, 0.5}, {0, 0, -5}, {0, 0, 1}, {2, 8});
  check_distances(RoundBoxShape{{1, 1, 1}, 1}, {-5, 0.6, 0}, {1, 0, 0}, {4.2, 5.8});
  check_distances(PlaneShape{}, {0, 3, 0}, {0, -1, 0}, {3});
}

TEST_CASE("parameters are normalised to the unit shape") {
  CHECK(compile(scene_with(TorusShape{4, 1})).instances[0].parameters.x == 0.25f);
  CHECK(compile(scene_with(DiskShape{4, 1})).instances[0].parameters.x == 0.25f);
  CHECK(compile(scene_with(ConeShape{2, 8, 1, false})).instances[0].parameters == float4{0.25f, 1, 0, 0});
  CHECK(compile(scene_with(RoundBoxShape{{2, 4, 1}, 1})).instances[0].parameters ==
        float4{0.5f, 1, 0.25f, 0.25f});
  CHECK(compile(scene_with(BoxShape{{2, 4, 1}})).instances[0].pattern_scale == float4{2, 4, 1, 1});
}

TEST_CASE("world bounds hold the surface and are tight") {
  std::mt19937 random(3);
  const auto uniform = [&] { return static_cast<double>(random()) * 0x1p-31 - 1; };
  for (const Shape& shape : bounded_shapes) {
    SceneDescription description = scene_with(shape, some_transform());
    description.meshes.push_back(bumpy_sphere(20));
    const CompiledScene scene = compile(description);
    const Bounds box = instance_box(scene);
    Bounds seen = Bounds::none();
    for (int i = 0; i < 40000; ++i) {
      HostRay ray;
      ray.origin = dvec3(10, -20, 30) + 20.0 * dvec3(uniform(), uniform(), uniform());
      ray.direction = dvec3(10, -20, 30) + 4.0 * dvec3(uniform(), uniform(), uniform()) - ray.origin;
      for (const HostHit& hit : crossings(scene, 0, ray)) {
        const dvec3 p = ray.origin + hit.t * ray.direction;
        for (int axis = 0; axis < 3; ++axis)
          CHECK((p[axis] >= double(box.lower[axis]) && p[axis] <= double(box.upper[axis])));
        seen.extend(Lanes{static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z), 0});
      }
      if (i > 300 && shape.index() == 0) break;
    }
    if (shape.index() == 0) continue;
    for (int axis = 0; axis < 3; ++axis) {
      const float edge = box.upper[axis] - box.lower[axis];
      INFO("shape " << shape.index() << " axis " << axis);
      CHECK(seen.lower[axis] - box.lower[axis] < 0.05f * edge);
      CHECK(box.upper[axis] - seen.upper[axis] < 0.05f * edge);
    }
  }
}

TEST_CASE("normals point outwards, under a mirror too") {
  dmat4 mirror(1);
  mirror[0][0] = -1;
  for (const dmat4& transform : {dmat4(1), some_transform(), some_transform() * mirror})
    for (const Shape& shape : bounded_shapes) {
      if (is_open(shape)) continue;
      SceneDescription description = scene_with(shape, transform);
      description.meshes.push_back(bumpy_sphere(20));
      const CompiledScene scene = compile(description);
      const HostRay ray{dvec3(transform * glm::dvec4(-7, 0.1, 0.2, 1)),
                        dvec3(transform * glm::dvec4(1, 0.02, -0.01, 0))};
      const auto hits = crossings(scene, 0, ray);
      REQUIRE(hits.size() % 2 == 0);
      REQUIRE(hits.size() >= 2);
      const dvec3 d = object_ray(scene.instances[0], ray).direction;
      for (std::size_t i = 0; i < hits.size(); ++i) CHECK((glm::dot(hits[i].ng, d) < 0) == (i % 2 == 0));
    }
}

TEST_CASE("an instance without transform is marked as such") {
  CHECK(compile(scene_of(bumpy_sphere(5))).instances[0].flags & INSTANCE_IDENTITY);
  CHECK(compile(scene_with(SphereShape{1})).instances[0].flags & INSTANCE_IDENTITY);
  CHECK_FALSE(compile(scene_with(SphereShape{2})).instances[0].flags & INSTANCE_IDENTITY);
}

TEST_CASE("planes stand behind the bounded instances") {
  SceneDescription scene = scene_with(PlaneShape{});
  for (int i = 0; i < 3; ++i) {
    scene.objects.push_back(scene.objects[0]);
    scene.objects.back().shape = SphereShape{1};
  }
  const CompiledScene flat = compile(scene);
  CHECK(flat.info.bounded_count == 3);
  CHECK(flat.info.instance_count == 4);
  CHECK(flat.instances[3].shape == SHAPE_PLANE);
  CHECK(flat.instances[3].object == 0);
  CHECK(flat.instances[3].world_center.w == 0);
  CHECK(flat.features.unbounded);
}

/// A mesh of radius 1 and `count` spheres of `radius` around it.
SceneDescription mesh_and_spheres(int count, double radius) {
  SceneDescription scene = scene_of(bumpy_sphere(10));
  for (int i = 0; i < count; ++i) {
    Object sphere = scene.objects[0];
    sphere.shape = SphereShape{radius};
    sphere.world_from_object[3] = {std::cos(i), 0.1 * i - 0.8, std::sin(i), 1};
    scene.objects.push_back(sphere);
  }
  return scene;
}

TEST_CASE("small solids beside a mesh are in the scene's BVH, however few they are") {
  for (const int count : {1, 2, 16, 17}) {
    const CompiledScene flat = compile(mesh_and_spheres(count, 0.01));
    CHECK(flat.info.bounded_count == static_cast<u32>(count) + 1);
    CHECK(flat.info.instance_count == flat.info.bounded_count);
  }
}

TEST_CASE("solids beside a mesh that many rays meet are offered to each batch, up to a few") {
  CompiledScene flat = compile(mesh_and_spheres(2, 0.9));
  CHECK(flat.info.bounded_count == 1);
  CHECK(flat.instances[0].shape == SHAPE_MESH);
  CHECK(flat.info.instance_count == 3);

  SceneDescription mixed = mesh_and_spheres(6, 0.01);
  mixed.objects[3].shape = SphereShape{0.9};
  flat = compile(mixed);
  CHECK(flat.info.bounded_count == 6);
  CHECK(flat.info.instance_count == 7);
  CHECK(flat.instances[6].object == 3);

  CHECK(compile(mesh_and_spheres(40, 0.9)).info.bounded_count == 41);
  flat = compile(scene_with(SphereShape{}));
  CHECK(flat.info.bounded_count == 1);  // no mesh: nothing is taken out
}

TEST_CASE("a lathe beside a mesh is in the scene's BVH, however large it is") {
  SceneDescription scene = mesh_and_spheres(2, 0.9);
  scene.objects[1].shape = LatheShape{};
  const CompiledScene flat = compile(scene);
  CHECK(flat.info.bounded_count == 2);
  CHECK(flat.instances[2].shape == SHAPE_SPHERE);
}

TEST_CASE("sizes that make no solid are errors at the object's place") {
  dmat4 singular(1);
  singular[1][1] = 0;
  const std::vector<SceneDescription> bad = {
      scene_with(SphereShape{0}),           scene_with(BoxShape{{1, -1, 1}}),
      scene_with(ConeShape{0, 0, 1}),       scene_with(TorusShape{1, 1}),
      scene_with(DiskShape{1, 1}),          scene_with(RoundBoxShape{{1, 1, 0.1}, 0.2}),
      scene_with(SphereShape{1}, singular), scene_with(SphereShape{1e-40})};
  for (const SceneDescription& scene : bad) {
    try {
      compile(scene);
      FAIL("compiled");
    } catch (const SceneError& error) {
      CHECK(error.place == "/objects/0");
    }
  }
}

TEST_CASE("a mesh of extreme coordinates is held in another unit, which its instance undoes") {
  const HostRay ray{{0.3, 0.2, 5}, {0.01, 0.02, -1}};
  const auto expected = trace_host(compile(scene_of(bumpy_sphere(12))), ray);
  REQUIRE(expected);
  for (const double unit : {1e-36, 1e-16, 1e-8, 1e8, 1e14, 1e35}) {
    SceneDescription scene = scene_of(bumpy_sphere(12));
    for (glm::vec3& p : scene.meshes[0].positions) p = glm::vec3(dvec3(p) * unit);
    scene.objects[0].world_from_object = dmat4(glm::dmat3(1 / unit));
    CAPTURE(unit);
    const CompiledScene flat = compile(scene);
    float greatest = 0;
    for (const TriangleBlock& block : flat.blocks)
      for (const float y : block.v1_y) greatest = std::max(greatest, std::abs(y));
    CHECK((greatest > 1e-11f && greatest < 1e11f));
    CHECK(flat.instances[0].pattern_scale.x * flat.instances[0].object_from_world[0].x == Approx(unit));
    const auto hit = trace_host(flat, ray);
    REQUIRE(hit);
    CHECK(hit->t == Approx(expected->t).epsilon(1e-6));
    CHECK(flat.figures.box.upper[1] == Approx(1).epsilon(0.2));
  }
}
