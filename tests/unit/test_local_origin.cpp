// Tables count positions from a point near the view, so that a scene may lie anywhere.
#include <glm/gtc/matrix_transform.hpp>

#include "catch.h"
#include "compile/compiled_scene.h"
#include "compile/local_origin.h"
#include "render/hash.h"
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
    object.world_from_object = glm::translate(dmat4(1), shift + dvec3(0, -1, 0));
    scene.objects.push_back(object);
  }
  return scene;
}

bool same(const float4& a, const float4& b) { return a == b; }

}  // namespace

TEST_CASE("a scene near the origin is not moved") {
  for (const char* name : {"cornell", "hollow_ice", "mandelbox", "spheres", "fractal_in_ice", "lights"})
    CHECK(local_origin(load_scene(SUNDOG_SOURCE_DIR "/scenes/" + std::string(name) + ".json").camera) ==
          dvec3(0));
  CHECK(local_origin(Camera{}) == dvec3(0));
  Camera nowhere;
  nowhere.target = nowhere.position = dvec3(7);
  CHECK(local_origin(nowhere) == dvec3(0));
}

TEST_CASE("a scene moved by round numbers compiles to the same tables") {
  const CompiledScene near = compile(moved_scene(dvec3(0)));
  for (const dvec3& shift : {dvec3(100, 0, 0), dvec3(1e5, 1e5, -1e5), dvec3(0, 1e9, 0)}) {
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
  Camera camera;
  camera.target = dvec3(1234.5678, -0.3, 1e-7);
  for (const double length : {100.0, 1.0, 1e-6}) {
    camera.position = camera.target + dvec3(0, 0, length);
    const dvec3 origin = local_origin(camera);
    for (int axis = 0; axis < 3; ++axis) CHECK(std::abs(camera.target[axis] - origin[axis]) <= 2 * length);
    CHECK(std::abs(camera.target.x - origin.x) <= length / 4);
  }
}

TEST_CASE("a point is split into floats without loss of what they can hold") {
  const SplitPoint parts = split_point(dvec3(1e5 + 0.1, -1e9 - 0.25, 3));
  CHECK(double(parts.high.x) + double(parts.low.x) == Approx(1e5 + 0.1).epsilon(1e-14));
  CHECK(double(parts.high.y) + double(parts.low.y) == -1e9 - 0.25);
  CHECK(parts.low.z == 0);
}
