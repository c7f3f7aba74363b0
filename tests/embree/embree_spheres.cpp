// Recognises balls among objects, and copies them into a geometry of Embree.
#include "embree_spheres.h"

#include <cmath>

namespace sundog {

std::optional<Ball> as_ball(const Object& object) {
  const SphereShape* sphere = std::get_if<SphereShape>(&object.shape);
  if (!sphere) return std::nullopt;
  const glm::dmat3 axes(object.world_from_object);
  const glm::dmat3 squares = glm::transpose(axes) * axes;  // a multiple of the identity where angles are kept
  const double square = squares[0][0];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (!(std::abs(squares[i][j] - (i == j ? square : 0)) <= 1e-6 * square)) return std::nullopt;
  return Ball{glm::vec3(object.world_from_object[3]), static_cast<float>(sphere->radius * std::sqrt(square))};
}

RTCGeometry embree_spheres(RTCDevice device, const std::vector<Ball>& balls) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
  auto* vertices = static_cast<glm::vec4*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, sizeof(glm::vec4), balls.size()));
  for (const Ball& ball : balls) *vertices++ = glm::vec4(ball.center, ball.radius);
  rtcCommitGeometry(geometry);
  return geometry;
}

}  // namespace sundog
