// See shapes.h.
#include "compile/shapes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/error.h"
#include "scene/kinds.h"

namespace sundog {
namespace {

constexpr std::size_t most_arcs = 1024;

struct ShapeReader {
  const std::string& file;
  const Object& object;

  void want(bool fine, const std::string& wanted) const {
    if (!fine)
      throw SceneError(file, object.place, fmt::format("object \"{}\": wanted {}", object.name, wanted));
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
  UnitShape operator()(const RectangleShape& s) const {
    for (int axis = 0; axis < 2; ++axis) want_positive(s.half[axis], "half size");
    return {SHAPE_RECTANGLE, {s.half.x, std::max(s.half.x, s.half.y), s.half.y}, {}};
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
  UnitShape operator()(const LatheShape& s) const {
    const double widest = std::max(s.radius, s.half_height);
    want_positive(s.radius, "radius");
    auto revolution = std::make_shared<const Revolution>(s, widest);
    const std::size_t count = revolution->arcs().size();
    want(count <= most_arcs, fmt::format("a profile of at most {} arcs, found {}", most_arcs, count));
    return {SHAPE_LATHE,
            dvec3(widest),
            {0, static_cast<float>(count), static_cast<float>(s.radius / widest),
             static_cast<float>(s.half_height / widest)},
            std::move(revolution)};
  }
};

std::logic_error no_such(const UnitShape& unit, const char* what) {
  return std::logic_error(fmt::format("a {} has not {}", shape_names.at(unit.shape), what));
}

std::vector<FlatFace> caps(double bottom_radius, double top_radius) {
  const dvec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  std::vector<FlatFace> faces;
  if (bottom_radius > 0) faces.push_back({y, -y, bottom_radius * x, bottom_radius * z});
  if (top_radius > 0) faces.push_back({y, y, top_radius * x, top_radius * z});
  return faces;
}

std::vector<FlatFace> rings(const Revolution& revolution) {
  std::vector<FlatFace> faces;
  for (const dvec2& ring : revolution.rings())
    faces.push_back({{0, 1, 0}, {0, ring.y, 0}, {ring.x, 0, 0}, {0, 0, ring.x}});
  return faces;
}

std::vector<FlatFace> box_faces(const dvec3& half, double round) {
  std::vector<FlatFace> faces;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      dvec3 n(0), u(0), v(0);
      const int next = (axis + 1) % 3, last = (axis + 2) % 3;
      n[axis] = 1;
      u[next] = half[next] - round;
      v[last] = half[last] - round;
      faces.push_back({n, side * half[axis] * n, u, v});
    }
  return faces;
}

double box_distance(const dvec3& p, const dvec3& half, double round) {
  const dvec3 out = glm::abs(p) - (half - round);
  return glm::length(glm::max(out, dvec3(0))) + std::min(std::max({out.x, out.y, out.z}), 0.0) - round;
}

}  // namespace

UnitShape unit_shape(const std::string& file, const Object& object) {
  return std::visit(ShapeReader{file, object}, object.shape);
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
    case SHAPE_RECTANGLE:
      return size.x + size.z;
    case SHAPE_TORUS:
      return across + double(p.x) * length;
    case SHAPE_ROUNDBOX:
      return glm::dot(dvec3(p.x, p.y, p.z) - double(p.w), size) + double(p.w) * length;
    case SHAPE_LATHE:
      return unit.revolution->reach(across, d.y);
    case SHAPE_PLANE:
    case SHAPE_MESH:
    case SHAPE_SDF:
      break;
  }
  throw no_such(unit, "a reach");
}

std::vector<FlatFace> flat_faces(const UnitShape& unit) {
  const float4& p = unit.parameters;
  switch (unit.shape) {
    case SHAPE_PLANE:
      return {{{0, 1, 0}, {0, 0, 0}, {1, 0, 0}, {0, 0, 1}, true}};
    case SHAPE_BOX:
      return box_faces(dvec3(1), 0);
    case SHAPE_ROUNDBOX:
      return box_faces({p.x, p.y, p.z}, double(p.w));
    case SHAPE_CYLINDER:
      return caps(p.x != 0 ? 1 : 0, p.x != 0 ? 1 : 0);
    case SHAPE_CONE:
      return caps(p.z != 0 ? double(p.x) : 0, p.z != 0 ? double(p.y) : 0);
    case SHAPE_DISK:
    case SHAPE_RECTANGLE:
      return {{{0, 1, 0}, {0, 0, 0}, {1, 0, 0}, {0, 0, 1}}};
    case SHAPE_LATHE:
      return rings(*unit.revolution);
    case SHAPE_SPHERE:
    case SHAPE_TORUS:
    case SHAPE_MESH:
    case SHAPE_SDF:
      return {};
  }
  throw no_such(unit, "faces");
}

std::optional<Curvature> curvature(const UnitShape& unit) {
  const double x = double(unit.parameters.x), y = double(unit.parameters.y), w = double(unit.parameters.w);
  switch (unit.shape) {
    case SHAPE_SPHERE:
      return Curvature{1};
    case SHAPE_CYLINDER:
      return Curvature{1, true};
    case SHAPE_CONE:
      return Curvature{std::min(x, y) > 0 ? 1 / std::min(x, y) : INFINITY};
    case SHAPE_TORUS:
      return Curvature{1 / std::min(x, 1 - x)};
    case SHAPE_ROUNDBOX:
      return w > 0 ? std::optional(Curvature{1 / w}) : std::nullopt;
    case SHAPE_LATHE:
      return Curvature{unit.revolution->greatest_curvature(dvec3(0), INFINITY)};
    case SHAPE_PLANE:
    case SHAPE_BOX:
    case SHAPE_DISK:
    case SHAPE_RECTANGLE:
    case SHAPE_MESH:
    case SHAPE_SDF:
      return std::nullopt;
  }
  throw no_such(unit, "a curvature");
}

double unit_distance(const UnitShape& unit, const dvec3& q) {
  const float4& p = unit.parameters;
  const double across = std::hypot(q.x, q.z);
  switch (unit.shape) {
    case SHAPE_SPHERE:
      return glm::length(q) - 1;
    case SHAPE_PLANE:
      return q.y;
    case SHAPE_BOX:
      return box_distance(q, dvec3(1), 0);
    case SHAPE_CYLINDER:
      return std::max(across - 1, std::abs(q.y) - 1);
    case SHAPE_CONE: {
      const double middle = 0.5 * (double(p.x) + double(p.y)), slope = 0.5 * (double(p.y) - double(p.x));
      return std::max((across - middle - slope * q.y) / std::hypot(1.0, slope), std::abs(q.y) - 1);
    }
    case SHAPE_TORUS:
      return std::hypot(across - 1, q.y) - double(p.x);
    case SHAPE_ROUNDBOX:
      return box_distance(q, dvec3(p.x, p.y, p.z), double(p.w));
    case SHAPE_LATHE:
      return unit.revolution->distance(q);
    case SHAPE_DISK:
    case SHAPE_RECTANGLE:
    case SHAPE_MESH:
    case SHAPE_SDF:
      break;
  }
  throw no_such(unit, "a distance");
}

}  // namespace sundog
