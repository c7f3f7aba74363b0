// Tables count positions from a point near the view, so that a scene may lie anywhere.
#include <glm/gtc/matrix_transform.hpp>

#include "catch.h"
#include "compile/compiled_scene.h"
#include "compile/view/local_origin.h"
#include "render/film/hash.h"
#include "scene/load.h"

using namespace sundog;

namespace {

/// A light and a plane beside a ball, all moved.
SceneDescription moved_scene(const dvec3& shift) {
  SceneDescription scene;
  scene.media.resize(1);
  scene.materials.resize(1);
  scene.camera.position = dvec3(1, 2, 6) + shift;
  scene.camera.target = dvec3(0.25, 0, 0) + shift;
  scene.lights.emplace_back().position = dvec3(3, 4, 5) + shift;
  for (const Shape& shape : {Shape(SphereShape{0.7}), Shape(PlaneShape{})}) {
    Object object;
    object.shape = shape;
    object.material = 0;
    const double height = std::holds_alternative<PlaneShape>(shape) ? -1 : 0;
    object.world_from_object = glm::translate(dmat4(1), shift + dvec3(0, height, 0));
    scene.objects.push_back(object);
  }
  return scene;
}

bool same(const float4& a, const float4& b) { return a == b; }

}  // namespace

TEST_CASE("a scene near the origin is not moved") {
  for (const char* name : {"cornell", "hollow_ice", "mandelbox", "spheres", "fractal_in_ice", "lights"})
    CHECK(local_origin(load_scene(SUNDOG_SOURCE_DIR "/scenes/" + std::string(name) + ".json")) == dvec3(0));
  CHECK(local_origin(SceneDescription{}) == dvec3(0));
  SceneDescription nowhere;
  nowhere.camera.target = nowhere.camera.position = dvec3(7);
  CHECK(local_origin(nowhere) == dvec3(0));
}

TEST_CASE("a scene moved by round numbers, or odd ones, compiles to the same tables") {
  const CompiledScene near = compile(moved_scene(dvec3(0)));
  for (const dvec3& shift :
       {dvec3(100, 0, 0), dvec3(1e5, 1e5, -1e5), dvec3(0, 1e9, 0), dvec3(12345.678, -321.7, 98.6),
        dvec3(98765.4321, 0, -1234567.891), dvec3(12345, -777, 333)}) {
    CAPTURE(shift.x, shift.y, shift.z);
    const CompiledScene far = compile(moved_scene(shift));
    CHECK(far.origin == shift);
    CHECK(same(far.info.camera_position, near.info.camera_position));
    CHECK(same(far.lights[0].position, near.lights[0].position));
    for (std::size_t i = 0; i < 2; ++i)
      for (int row = 0; row < 3; ++row)
        CHECK(same(far.instances[i].object_from_world[row], near.instances[i].object_from_world[row]));
    CHECK(hash_scene(far) != hash_scene(near));
  }
}

TEST_CASE("scenes whose origins differ by less than a float's spacing have different hashes") {
  const auto hash_at = [](double x) { return hash_scene(compile(moved_scene(dvec3(x, 0, 0)))); };
  CHECK(hash_at(1e9) != hash_at(1e9 + 1));
}

TEST_CASE("the origin lies beside the target, however near the camera is to it") {
  SceneDescription scene;
  Camera& camera = scene.camera;
  camera.target = dvec3(1234.5678, -0.3, 1e-7);
  for (const double x : {1234.0, 1200.0, 0.0}) scene.objects.emplace_back().world_from_object[3].x = x;
  for (const double length : {100.0, 1.0, 1e-6}) {
    camera.position = camera.target + dvec3(0, 0, length);
    const dvec3 origin = local_origin(scene);
    for (int axis = 0; axis < 3; ++axis) CHECK(std::abs(camera.target[axis] - origin[axis]) <= 2 * length);
  }
}

TEST_CASE("a scene whose places are no short decimals counts from a round number beside its target") {
  SceneDescription scene = moved_scene(dvec3(0));
  for (int i = 0; i < 5; ++i) scene.objects.emplace_back().world_from_object[3].x = std::sqrt(1e6 + i);
  scene.camera.target.x = 1000 + std::sqrt(3.0);
  scene.camera.position.x = 1000 + std::sqrt(7.0);
  scene.lights.clear();
  const dvec3 origin = local_origin(scene);
  CHECK(std::abs(origin.x - scene.camera.target.x) <= 2);
  CHECK(origin.x == std::round(origin.x));
}

TEST_CASE("a point is split into floats without loss of what they can hold") {
  const SplitPoint parts = split_point(dvec3(1e5 + 0.1, -1e9 - 0.25, 3));
  CHECK(double(parts.high.x) + double(parts.low.x) == Approx(1e5 + 0.1).epsilon(1e-14));
  CHECK(double(parts.high.y) + double(parts.low.y) == -1e9 - 0.25);
  CHECK(parts.low.z == 0);
}
