// See camera.h.
#include "compile/camera.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "base/error.h"
#include "base/limits.h"
#include "compile/local_origin.h"
#include "compile/pack.h"

namespace sundog {
namespace {

[[noreturn]] void fail(const SceneDescription& scene, const char* place, const std::string& what) {
  throw SceneError(scene.file.string(), place, what);
}

/// `vector` at length 1; fails with `what` when it has no direction.
dvec3 unit(const SceneDescription& scene, const dvec3& vector, const char* place, const std::string& what) {
  const double length = glm::length(vector);
  if (!(length > 0) || !std::isfinite(length)) fail(scene, place, what);
  return vector / length;
}

std::string text(const dvec3& v) { return fmt::format("({}, {}, {})", v.x, v.y, v.z); }

}  // namespace

void set_camera(const SceneDescription& scene, const dvec3& origin, SceneInfo& info) {
  const Camera& camera = scene.camera;
  const ImageSettings& image = scene.image;
  if (image.width < 1 || image.height < 1)
    fail(scene, "/image/size", fmt::format("wanted at least 1x1, found {}x{}", image.width, image.height));
  if (!(camera.fov > 0 && camera.fov < 180))
    fail(scene, "/camera/fov", fmt::format("wanted degrees between 0 and 180, found {}", camera.fov));

  const dvec3 forward = unit(scene, camera.target - camera.position, "/camera/target",
                             "wanted a target apart from the position, found both at " + text(camera.target));
  const dvec3 up = unit(scene, camera.up, "/camera/up", "wanted a direction, found " + text(camera.up));
  const dvec3 side = glm::cross(forward, up);
  if (glm::length(side) < 1e-9)
    fail(scene, "/camera/up", "wanted a direction across the view, found one along it: " + text(camera.up));
  const dvec3 right = glm::normalize(side), screen_up = glm::cross(right, forward);

  const double pixel = 2 * std::tan(camera.fov * std::numbers::pi / 360) / image.height;
  info.camera_position = pack(camera.position - origin);
  info.camera_corner =
      pack(forward - right * (pixel * image.width / 2) + screen_up * (pixel * image.height / 2));
  info.camera_dx = pack(right * pixel);
  info.camera_dy = pack(-screen_up * pixel);
  info.camera_forward = pack(forward, camera.near);
  info.background_bottom = pack(image.background_bottom, camera.far);
  info.background_top = pack(image.background_top);
  info.up = pack(up);
  const SplitPoint place = split_point(origin);
  info.origin = place.high;
  info.origin_rest = place.low;
  if (!is_frame_size(image.width, image.height))
    fail(scene, "/image",
         fmt::format("wanted at most {} pixels in all, found {} x {}", most_pixels, image.width,
                     image.height));
  info.width = static_cast<u32>(image.width);
  info.height = static_cast<u32>(image.height);
  info.max_depth = static_cast<u32>(scene.render.max_depth);
  info.samples = static_cast<u32>(scene.render.samples);
  info.cutoff = static_cast<float>(scene.render.cutoff);
}

}  // namespace sundog
