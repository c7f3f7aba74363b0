// Computes matrices from primaries and white points, which are adapted by Bradford's cone responses.
#include "base/colors/color_space.h"

namespace sundog {

using glm::dmat3;
using glm::dvec3;

dvec3 xyz_of(glm::dvec2 c) { return dvec3(c.x, c.y, 1 - c.x - c.y) / c.y; }

dmat3 xyz_from(const Primaries& space) {
  dmat3 xyz(xyz_of(space.red), xyz_of(space.green), xyz_of(space.blue));
  const dvec3 luminances = glm::inverse(xyz) * xyz_of(space.white);
  for (int i = 0; i < 3; ++i) xyz[i] *= luminances[i];
  return xyz;
}

dmat3 adaptation(glm::dvec2 from_white, glm::dvec2 to_white) {
  const dmat3 cones_from_xyz =
      glm::transpose(dmat3(0.8951, 0.2664, -0.1614, -0.7502, 1.7135, 0.0367, 0.0389, -0.0685, 1.0296));
  const dvec3 gain = (cones_from_xyz * xyz_of(to_white)) / (cones_from_xyz * xyz_of(from_white));
  const dmat3 scale(gain.x, 0, 0, 0, gain.y, 0, 0, 0, gain.z);
  return glm::inverse(cones_from_xyz) * scale * cones_from_xyz;
}

dmat3 conversion(const Primaries& from, const Primaries& to) {
  return glm::inverse(xyz_from(to)) * adaptation(from.white, to.white) * xyz_from(from);
}

}  // namespace sundog
