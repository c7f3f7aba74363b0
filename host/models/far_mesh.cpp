// Rounds the middle of the box to a multiple of a power of two above the mesh's size, subtracts it from the
// positions, and moves the objects by it.
#include "models/far_mesh.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <utility>

namespace sundog::models {

dvec3 near_origin(const dvec3& lower, const dvec3& upper, double far_sizes) {
  const dvec3 middle = 0.5 * (lower + upper), edges = upper - lower;
  const double size = std::max({edges.x, edges.y, edges.z});
  dvec3 origin(0);
  if (!(size > 0) || !std::isfinite(size)) return origin;
  const double step = std::ldexp(1.0, std::ilogb(size) + 1);
  for (int axis = 0; axis < 3; ++axis)
    if (std::abs(middle[axis]) > far_sizes * size) origin[axis] = std::round(middle[axis] / step) * step;
  return origin;
}

dvec3 near_origin(std::span<const dvec3> positions, double far_sizes) {
  dvec3 lower(std::numeric_limits<double>::infinity()), upper(-lower);
  for (const dvec3& p : positions) lower = glm::min(lower, p), upper = glm::max(upper, p);
  return near_origin(lower, upper, far_sizes);
}

void bring_near(Model& model) {
  model.origins.resize(model.meshes.size(), dvec3(0));
  for (std::size_t i = 0; i < model.meshes.size(); ++i) {
    Mesh& mesh = model.meshes[i];
    glm::vec3 lower(std::numeric_limits<float>::infinity()), upper(-lower);
    for (const glm::vec3& p : std::as_const(mesh.positions))
      lower = glm::min(lower, p), upper = glm::max(upper, p);
    const dvec3 origin = near_origin(dvec3(lower), dvec3(upper));
    if (origin == dvec3(0)) continue;
    model.origins[i] += origin;
    for (glm::vec3& p : mesh.positions) p = glm::vec3(dvec3(p) - origin);
  }
  for (Object& object : model.objects)
    if (const auto* shape = std::get_if<MeshShape>(&object.shape))
      if (const dvec3& origin = model.origins[static_cast<std::size_t>(shape->mesh)]; origin != dvec3(0))
        object.world_from_object = glm::translate(object.world_from_object, origin);
}

}  // namespace sundog::models
