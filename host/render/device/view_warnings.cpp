// Compares a pixel's size with the precision of floats at the camera and at each field.
#include "render/device/view_warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compile/placing/coarse_starts.h"
#include "compile/view/field_view.h"

namespace sundog {
namespace {

constexpr float least_angle = 4e-7f;  // a pixel's angle: a few float spacings at 1

float pixel_angle(const CompiledScene& scene) {
  const float4& dx = scene.info.camera_dx;
  const float spread = scene.features.orthographic ? scene.info.camera_corner.w : 1;
  return std::sqrt(dx.x * dx.x + dx.y * dx.y + dx.z * dx.z) * spread;
}

// The error of estimates in doubles, relative to the largest coordinate.
constexpr double double_footprint = 8e-15;

bool ends_doubles(const FieldView& view) {
  const double size = std::max({1.0, std::abs(view.place.x), std::abs(view.place.y), std::abs(view.place.z)});
  return view.footprint > 0 && view.footprint < double_footprint * size;
}

void add_field_warnings(const SceneDescription& scene, const CompiledScene& flat,
                        std::span<const DeviceInfo> devices, std::vector<std::string>& warnings) {
  if (pixel_angle(flat) < least_angle)
    warnings.push_back(
        "the field of view is so narrow that floats do not tell its pixels apart: move the camera nearer to "
        "what it sees and raise fov");
  if (!any_deep(views_of(scene))) return;
  for (const DeviceInfo& device : devices)
    if (device.extensions.find("cl_khr_fp64") == std::string::npos)
      warnings.push_back(fmt::format(
          "{} has no doubles (cl_khr_fp64), which so near a view of a field needs: it will look flat "
          "or torn; choose another device, or move the camera back",
          device.label()));
  for (const Object& object : scene.objects)
    if (std::holds_alternative<FieldShape>(object.shape) && ends_doubles(view_of_field(scene, object)))
      warnings.push_back(fmt::format(
          "the camera is so near to \"{}\" that doubles do not tell its pixels apart, and its light and "
          "shadows are lost: move it back, or widen fov",
          object.name.empty() ? object.place : object.name));
}

void add_size_warnings(const SceneDescription& scene, const CompiledScene& flat,
                       std::vector<std::string>& warnings) {
  constexpr std::size_t most_named = 4;
  const std::vector<CoarseStart> coarse = coarse_starts(scene, flat.origin);
  for (std::size_t i = 0; i < std::min(coarse.size(), most_named); ++i)
    warnings.push_back(
        fmt::format("\"{}\" is so large, or so far from its own origin, that rays leave it {:.2g} off its "
                    "surface, and the camera is {:.2g} away: what lies closer to it is lost in shadows and "
                    "reflections; make it smaller or move the camera back",
                    coarse[i].object, coarse[i].away, coarse[i].distance));
  if (coarse.size() > most_named)
    warnings.push_back(fmt::format("so are {} other objects", coarse.size() - most_named));
}

}  // namespace

std::vector<std::string> view_warnings(const SceneDescription& scene, const CompiledScene& flat,
                                       std::span<const DeviceInfo> devices) {
  std::vector<std::string> warnings;
  if (!flat.sdf_fields.empty()) add_field_warnings(scene, flat, devices, warnings);
  add_size_warnings(scene, flat, warnings);
  return warnings;
}

}  // namespace sundog
