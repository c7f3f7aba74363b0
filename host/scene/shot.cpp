// Builds matrices in the spaces of ImfStandardAttributes.h, which are RenderMan's, with a depth that makes
// NDC invertible.
#include "scene/shot.h"

#include <cmath>
#include <numbers>

namespace sundog {
namespace {

/// A matrix row that maps a point p to dot(axis, p - origin).
glm::dvec4 row(const dvec3& axis, const dvec3& origin) { return {axis, -glm::dot(axis, origin)}; }

}  // namespace

Shot shot_of(const SceneDescription& scene, std::optional<double> frame) {
  const Camera& camera = scene.camera;
  const dvec3 forward = glm::normalize(camera.target - camera.position),
              right = glm::normalize(glm::cross(forward, camera.up)), up = glm::cross(right, forward);
  const glm::dvec4 x = row(right, camera.position), y = row(up, camera.position),
                   z = row(forward, camera.position), w{0, 0, 0, 1};
  const bool parallel = camera.orthographic > 0;
  const double height = parallel ? camera.orthographic : 2 * std::tan(camera.fov * std::numbers::pi / 360),
               width = height * scene.image.width / scene.image.height,
               near = camera.near > 0 ? camera.near : 1;
  Shot shot;
  shot.world_to_camera = glm::transpose(glm::dmat4(x, y, z, w));
  // Readers discard NDC's z; 1 - near / z makes the matrix invertible. Parallel rays need no division.
  const glm::dvec4 divisor = parallel ? w : z, middle = 0.5 * divisor;
  shot.world_to_ndc = glm::transpose(
      glm::dmat4(middle + x / width, middle - y / height, parallel ? z : z - near * w, divisor));
  shot.window_width = width;
  const double depth = camera.lens.focus ? *camera.lens.focus : glm::length(camera.target - camera.position);
  if (camera.lens.radius > 0) shot.focus = depth * scene.unit;
  if (!frame) return shot;
  shot.frame = static_cast<int>(std::lround(*frame));
  shot.frames_per_second = scene.frames_per_second;
  shot.exposure_seconds = camera.shutter / scene.frames_per_second;
  return shot;
}

}  // namespace sundog
