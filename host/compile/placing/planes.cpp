// Places planes, which have no bounds, so that their patterns lose no precision far away.
#include "compile/placing/instances.h"
#include "compile/surfaces/textures.h"
#include "compile/view/local_origin.h"

namespace sundog {
namespace {

/// The edge of a cell of the object's checkerboard; 0 without a checkerboard.
double checker_size(const SceneDescription& scene, const Object& object) {
  if (object.material < 0) return 0;
  const MaterialDescription& material = scene.materials[static_cast<std::size_t>(object.material)];
  return material.checker ? material.checker_size : 0;
}

}  // namespace

dmat4 place_of_plane(const SceneDescription& scene, const Object& object, const dvec3& origin) {
  dmat4 result = object.world_from_object;
  result[3] -= glm::dvec4(origin, 0);
  if (object.material >= 0 && has_maps(scene.materials[static_cast<std::size_t>(object.material)]))
    return result;
  const dmat4 local_from_object = result;
  const dvec3 here(glm::inverse(local_from_object)[3]);
  for (const int axis : {0, 2}) {
    const dvec3 along(local_from_object[axis]);
    const double length = glm::length(along), period = 2 * checker_size(scene, object);
    result[3] += glm::dvec4(far_part(here[axis] * length, period * length, scene.camera) / length * along, 0);
  }
  return result;
}

}  // namespace sundog
