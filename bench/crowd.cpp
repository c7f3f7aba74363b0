// See crowd.h.
#include "crowd.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <random>

#include "base/error.h"

namespace sundog {
namespace {

struct Box {
  dvec3 lower{std::numeric_limits<double>::max()}, upper{-std::numeric_limits<double>::max()};
};

/// Of all meshes, where objects place them. Throws SceneError when there are none.
Box extent(const SceneDescription& scene) {
  Box box;
  for (const Object& object : scene.objects) {
    const MeshShape* shape = std::get_if<MeshShape>(&object.shape);
    if (!shape) continue;
    for (const glm::vec3& p : scene.meshes.at(static_cast<std::size_t>(shape->mesh)).positions) {
      const dvec3 placed(object.world_from_object * glm::dvec4(p, 1));
      box.lower = glm::min(box.lower, placed);
      box.upper = glm::max(box.upper, placed);
    }
  }
  if (!(box.lower.x <= box.upper.x))
    throw SceneError(scene.file.string(), "/objects", "no mesh, where one was wanted to make a crowd of");
  return box;
}

}  // namespace

void make_crowd(SceneDescription& scene, unsigned copies, unsigned balls) {
  if (copies <= 1 && balls == 0) return;
  constexpr double spacing = 0.75, ball = 0.03;  // of the model's size
  const Box box = extent(scene);
  const dvec3 middle = 0.5 * (box.lower + box.upper), size = box.upper - box.lower;
  const double longest = std::max({size.x, size.y, size.z});
  const auto side = static_cast<unsigned>(std::ceil(std::cbrt(copies) - 1e-9));
  std::mt19937 random(1);  // its numbers are the same everywhere; those of distributions are not
  const auto uniform = [&] { return static_cast<double>(random()) / 4294967296.0; };
  const auto in_cube = [&] {
    const double x = uniform(), y = uniform(), z = uniform();
    return 2.0 * dvec3(x, y, z) - 1.0;
  };
  const std::vector<Object> model = scene.objects;
  if (copies > 1) scene.objects.clear();
  for (unsigned i = 0; copies > 1 && i < copies; ++i) {
    const dvec3 cell(i % side, i / side % side, i / side / side);
    const dvec3 at = spacing * longest * (cell - 0.5 * (side - 1.0)) + 0.1 * longest * in_cube();
    const double angle = 6.3 * uniform();
    const dmat4 turned =
        glm::rotate(glm::translate(dmat4(1), middle + at), angle, in_cube() + dvec3(0, 2, 0));
    for (Object object : model) {
      object.world_from_object = glm::translate(turned, -middle) * object.world_from_object;
      scene.objects.push_back(std::move(object));
    }
  }
  const double reach = (0.5 + 0.5 * spacing * (side - 1.0)) * longest;
  for (unsigned i = 0; i < balls; ++i) {
    Object object = model.at(0);
    object.shape = SphereShape{ball * longest};
    object.world_from_object = glm::translate(dmat4(1), middle + reach * in_cube());
    scene.objects.push_back(std::move(object));
  }
}

}  // namespace sundog
