#include "render/device/view_warnings.h"

#include <fmt/format.h>

#include <cmath>

namespace sundog {
namespace {

constexpr float least_angle = 4e-7f;  // of a pixel: a few of the spacings of floats about 1

float pixel_angle(const CompiledScene& scene) {
  const float4& dx = scene.info.camera_dx;
  return std::sqrt(dx.x * dx.x + dx.y * dx.y + dx.z * dx.z);
}

}  // namespace

std::vector<std::string> view_warnings(const CompiledScene& scene, std::span<const DeviceInfo> devices) {
  std::vector<std::string> warnings;
  if (scene.sdf_fields.empty()) return warnings;
  if (pixel_angle(scene) < least_angle)
    warnings.push_back(
        "the field of view is so narrow that floats do not tell its pixels apart: move the camera nearer to "
        "what it sees and raise fov");
  if (scene.field_source.find("deep_begin.h") == std::string::npos) return warnings;
  for (const DeviceInfo& device : devices)
    if (device.extensions.find("cl_khr_fp64") == std::string::npos)
      warnings.push_back(fmt::format(
          "{} has no doubles (cl_khr_fp64), which so near a view of a field needs: it will look flat "
          "or torn; choose another device, or move the camera back",
          device.label()));
  return warnings;
}

}  // namespace sundog
