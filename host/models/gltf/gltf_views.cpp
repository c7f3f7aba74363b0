// Reads and validates cameras (glTF 2.0, section 3.10) and punctual lights.
#include "models/gltf/gltf_views.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace sundog::models {

GltfCamera read_gltf_camera(const JsonAt& at) {
  GltfCamera camera;
  const std::string type = at.member("type").text();
  const auto perspective = at.find("perspective"), orthographic = at.find("orthographic");
  if (perspective && orthographic) at.fail("a camera must be either perspective or orthographic");
  const double infinity = std::numeric_limits<double>::infinity();
  if (type == "perspective") {
    const JsonAt p = at.member("perspective");
    camera.fov = p.member("yfov").number(positive);
    camera.near = p.member("znear").number(positive);
    camera.far = p.number("zfar", infinity, positive);
    if (const auto aspect = p.find("aspectRatio")) camera.aspect = aspect->number(positive);
    if (camera.far <= camera.near) p.fail("zfar must be beyond znear");
  } else if (type == "orthographic") {
    const JsonAt o = at.member("orthographic");
    for (const char* key : {"xmag", "ymag"})
      if (o.member(key).number() == 0) o.fail(fmt::format("{} must not be 0", key));
    camera.height = 2 * std::abs(o.member("ymag").number());
    camera.aspect = std::abs(o.member("xmag").number() / o.member("ymag").number());
    camera.near = o.member("znear").number(not_negative);
    camera.far = o.member("zfar").number(positive);
    if (camera.far <= camera.near) o.fail("zfar must be beyond znear");
  }
  return camera;
}

LightDescription read_gltf_light(const JsonAt& at) {
  LightDescription light;
  const std::string type = at.member("type").text();
  light.color = at.vector("color", dvec3(1), not_negative);
  light.intensity = at.number("intensity", 1, not_negative) / std::numbers::pi;
  if (type == "directional") {
    light.type = LightType::directional;
  } else if (type == "point" || type == "spot") {
    light.type = type == "point" ? LightType::point : LightType::spot;
    light.falloff = {0, 0, 1};
    light.range = at.number("range", 0, positive);
    light.square_edge = type == "spot";
  } else {
    at.member("type").fail("directional, point or spot wanted");
  }
  if (type == "spot") {
    const JsonAt spot = at.member("spot");
    const double quarter = std::numbers::pi / 2 + 1e-6;
    const double inner = spot.number("innerConeAngle", 0, {0, quarter, false});
    const double outer = spot.number("outerConeAngle", std::numbers::pi / 4, {0, quarter, true});
    if (inner > outer) spot.fail("innerConeAngle must not be above outerConeAngle");
    light.inner_angle = std::min(glm::degrees(inner), 89.9);
    light.outer_angle = std::min(glm::degrees(outer), 89.9);
  }
  return light;
}

}  // namespace sundog::models
