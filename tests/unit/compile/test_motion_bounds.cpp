// Boxes of things that move, turn and grow while the shutter is open: nothing leaves them, and they are not
// much larger than what the thing passes.
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "base/error.h"
#include "catch.h"
#include "compile/compiled_scene.h"
#include "compile/placing/motion.h"
#include "scene/load.h"
#include "scene_text.h"
#include "scenes.h"

using namespace sundog;
using glm::dvec3;

namespace {

constexpr dvec3 origin(3, -2, 1);

Bounds unit_box() {
  Bounds box = Bounds::none();
  box.extend(Lanes{-1, -1, -1, 0});
  box.extend(Lanes{1, 1, 1, 0});
  return box;
}

/// The box that a cube's corners pass through, in the world.
Bounds passed(const Object& object, int times) {
  Bounds box = Bounds::none();
  for (int i = 0; i <= times; ++i) {
    const glm::dmat4 at = world_at(object, double(i) / times) * object.world_from_object;
    for (int corner = 0; corner < 8; ++corner) {
      const dvec3 p(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
      const dvec3 q = dvec3(at * glm::dvec4(p, 1)) - origin;
      box.extend(Lanes{float(q.x), float(q.y), float(q.z), 0});
    }
  }
  return box;
}

Bounds bounds_of(const Object& object) {
  const Bounds unit = unit_box();
  UnitShape shape;
  shape.shape = SHAPE_MESH;
  return moving_bounds(object, shape, {&unit, 1},
                       glm::translate(glm::dmat4(1), -origin) * object.world_from_object, origin);
}

}  // namespace

TEST_CASE("nothing leaves the box of what it passes while it turns") {
  std::mt19937 random(7);
  const auto number = [&](double low, double high) {
    return low + (high - low) * double(random()) / double(std::mt19937::max());
  };
  const auto vector = [&](double size) {
    return dvec3(number(-size, size), number(-size, size), number(-size, size));
  };
  for (int i = 0; i < 200; ++i) {
    Object object;
    object.world_from_object =
        glm::translate(glm::dmat4(1), vector(4)) * glm::rotate(glm::dmat4(1), number(0, 3), vector(1));
    if (i % 2) object.moves_by = vector(3);
    for (int turn = 0; turn <= i % 3; ++turn) {
      TurnDescription made{.axis = vector(1), .degrees = number(-500, 500), .about = vector(5)};
      if (i % 4 == 0) made.growth = number(0.2, 3);
      if (i % 5 == 0) made.moves_by = vector(2);
      if (i % 7 == 0) made.frame = glm::dmat3(dvec3(2, 0.3, 0), dvec3(0, 0.5, 0), dvec3(0, 0.1, -1));
      object.turns.push_back(made);
    }
    const Bounds box = bounds_of(object), all = passed(object, 5000);
    double size = 0;
    for (int axis = 0; axis < 3; ++axis) size = std::max(size, double(all.upper[axis] - all.lower[axis]));
    INFO(i);
    for (int axis = 0; axis < 3; ++axis) {
      CHECK(box.lower[axis] <= all.lower[axis]);
      CHECK(box.upper[axis] >= all.upper[axis]);
      CHECK(double(box.upper[axis] - box.lower[axis]) <
            double(all.upper[axis] - all.lower[axis]) + 0.05 * size);
    }
  }
}

TEST_CASE("turns of groups and of what they hold are kept apart, and what stands still has none") {
  const SceneDescription scene = load_scene(SUNDOG_SOURCE_DIR "/tests/support/turning_things.json");
  const Object &ball = scene.objects.at(1), &mesh = scene.objects.at(2), &box = scene.objects.at(3);
  REQUIRE(ball.turns.size() == 2);
  CHECK(glm::distance(ball.turns[0].about, dvec3(0, 0, -0.4)) < 1e-12);
  CHECK(glm::distance(ball.turns[1].about, dvec3(ball.world_from_object[3])) < 1e-12);
  CHECK(glm::distance(ball.moves_by, dvec3(0.2, 0, 0)) < 1e-12);
  CHECK(glm::distance(mesh.turns.at(0).moves_by, dvec3(0, 0.2, -0.1)) < 1e-12);
  CHECK(box.turns.at(0).growth == 0.7);
  // A group's turn takes along what its objects do: the mesh at the end.
  const glm::dmat4 at_end = world_at(mesh, 1);
  const dvec3 middle(mesh.world_from_object[3]);
  const auto turned = [](double degrees) {
    return glm::dmat3(glm::rotate(glm::dmat4(1), glm::radians(degrees), dvec3(0, 1, 0)));
  };
  const dvec3 within = middle + dvec3(0, 0.2, -0.1), about(0, 0, -0.4);
  CHECK(glm::distance(dvec3(at_end * glm::dvec4(middle, 1)),
                      about + turned(70) * (within - about) + dvec3(0.2, 0, 0)) < 1e-12);
  const CompiledScene compiled = compile(scene);
  CHECK(compiled.features.turns);
  CHECK(compiled.turns.size() == 7);
  SceneDescription still = scene;
  for (Object& object : still.objects) object.turns.clear();
  CHECK_FALSE(compile(still).features.turns);
  CHECK(compile(still).turns.empty());
  SceneDescription too_far = scene;
  too_far.objects[3].turns[0].about = {1e300, 0, 0};
  CHECK_THROWS_AS(compile(too_far), SceneError);
}
