// See shapes.h.
#include "compile/shapes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace sundog {
namespace {

struct ShapeReader {
  const SceneDescription& scene;
  const Object& object;

  void want(bool fine, const std::string& wanted) const {
    if (!fine)
      throw SceneError(scene.file.string(), object.place,
                       fmt::format("object \"{}\": wanted {}", object.name, wanted));
  }
  void want_positive(double size, const char* name) const {
    want(size > 0 && std::isfinite(size), fmt::format("a {} above 0, found {}", name, size));
  }

  UnitShape operator()(const MeshShape&) const { return {}; }
  UnitShape operator()(const FieldShape&) const { return {SHAPE_SDF, dvec3(1), {}}; }
  UnitShape operator()(const PlaneShape&) const { return {SHAPE_PLANE, dvec3(1), {}}; }
  UnitShape operator()(const SphereShape& s) const {
    want_positive(s.radius, "radius");
    return {SHAPE_SPHERE, dvec3(s.radius), {}};
  }
  UnitShape operator()(const BoxShape& s) const {
    for (int axis = 0; axis < 3; ++axis) want_positive(s.half[axis], "half size");
    return {SHAPE_BOX, s.half, {}};
  }
  UnitShape operator()(const CylinderShape& s) const {
    want_positive(s.radius, "radius");
    want_positive(s.half_height, "half height");
    return {SHAPE_CYLINDER, dvec3(s.radius, s.half_height, s.radius), {s.capped ? 1.0f : 0.0f, 0, 0, 0}};
  }
  UnitShape operator()(const ConeShape& s) const {
    want(s.bottom_radius >= 0 && s.top_radius >= 0, "radii of 0 or more");
    const double widest = std::max(s.bottom_radius, s.top_radius);
    want_positive(widest, "bottom or top radius");
    want_positive(s.half_height, "half height");
    return {SHAPE_CONE,
            dvec3(widest, s.half_height, widest),
            {static_cast<float>(s.bottom_radius / widest), static_cast<float>(s.top_radius / widest),
             s.capped ? 1.0f : 0.0f, 0}};
  }
  UnitShape operator()(const DiskShape& s) const {
    want_positive(s.radius, "radius");
    want(s.inner_radius >= 0 && s.inner_radius < s.radius, "an inner radius from 0 to below the radius");
    return {SHAPE_DISK, dvec3(s.radius), {static_cast<float>(s.inner_radius / s.radius), 0, 0, 0}};
  }
  UnitShape operator()(const TorusShape& s) const {
    want_positive(s.major_radius, "major radius");
    want(s.minor_radius > 0 && s.minor_radius < s.major_radius,
         "a minor radius between 0 and the major radius");
    return {
        SHAPE_TORUS, dvec3(s.major_radius), {static_cast<float>(s.minor_radius / s.major_radius), 0, 0, 0}};
  }
  UnitShape operator()(const RoundBoxShape& s) const {
    for (int axis = 0; axis < 3; ++axis) want_positive(s.half[axis], "half size");
    const double least = std::min({s.half.x, s.half.y, s.half.z}),
                 most = std::max({s.half.x, s.half.y, s.half.z});
    want(s.radius >= 0 && s.radius <= least, "an edge radius from 0 to the smallest half size");
    float4 p{static_cast<float>(s.half.x / most), static_cast<float>(s.half.y / most),
             static_cast<float>(s.half.z / most), static_cast<float>(s.radius / most)};
    p.w = std::min({p.w, p.x, p.y, p.z});
    return {SHAPE_ROUNDBOX, dvec3(most), p};
  }
};

}  // namespace

UnitShape unit_shape(const SceneDescription& scene, const Object& object) {
  return std::visit(ShapeReader{scene, object}, object.shape);
}

double reach(const UnitShape& unit, const dvec3& d) {
  const float4& p = unit.parameters;
  const double length = glm::length(d), across = std::hypot(d.x, d.z);
  const dvec3 size(std::abs(d.x), std::abs(d.y), std::abs(d.z));
  switch (unit.shape) {
    case SHAPE_SPHERE:
      return length;
    case SHAPE_BOX:
      return size.x + size.y + size.z;
    case SHAPE_CYLINDER:
      return across + size.y;
    case SHAPE_CONE:
      return std::max(double(p.x) * across - d.y, double(p.y) * across + d.y);
    case SHAPE_DISK:
      return across;
    case SHAPE_TORUS:
      return across + double(p.x) * length;
    case SHAPE_ROUNDBOX:
      return glm::dot(dvec3(p.x, p.y, p.z) - double(p.w), size) + double(p.w) * length;
    default:
      return 0;
  }
}

}  // namespace sundog
