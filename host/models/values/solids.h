// The exact solids of shared/shapes.h, one struct each: its sizes, its unit shape and the transform from
// there, and, as static functions, the unit shape's geometry.
#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "models/values/revolution.h"
#include "shared/shapes.h"

namespace sundog {

using glm::dmat4;

struct UnitShape {
  ShapeKind shape = SHAPE_MESH;
  dvec3 scale{1};  // unit shape to object space
  float4 parameters{};
  std::shared_ptr<const Revolution> revolution{};  // of a lathe
};

/// A flat face, contained in the parallelogram center + [-1, 1] u + [-1, 1] v.
struct FlatFace {
  dvec3 normal, center, u, v;
  bool unbounded = false;
};
using FlatFaces = std::vector<FlatFace>;
FlatFaces cap_faces(double bottom_radius, double top_radius);  // at y = -1 and 1
FlatFaces box_faces(const dvec3& half, double round);
FlatFaces ring_faces(const Revolution& revolution);

/// Curvature of a solid's surface.
struct Curvature {
  double greatest;          // infinite at a cone's tip
  bool straight_y = false;  // stretching along y does not change it
};

double box_distance(const dvec3& p, const dvec3& half, double round);

/// Throws std::domain_error unless `size` is finite and above 0.
void want_positive(double size, const char* name);
/// Throws std::domain_error that names `wanted` unless `fine`.
inline void want(bool fine, const std::string& wanted) {
  if (!fine) throw std::domain_error("wanted " + wanted);
}

inline float to_float(double x) { return static_cast<float>(x); }
inline double across(const dvec3& d) { return std::hypot(d.x, d.z); }

// half_size(): half the size of the bounding box about the origin. open(): has no inside. unit() throws
// std::domain_error for sizes that the solid cannot have. reach(): the support, the maximum of dot(d, p) over
// its points p; unbounded solids have none. distance(): a lower bound, zero on the surface, negative inside,
// slope at most 1; a cylinder or cone counts as capped; solids that are always open have none.

struct PlaneShape {  // y = 0, normal +y, inside below
  bool open() const { return false; }
  UnitShape unit() const { return {SHAPE_PLANE}; }
  static FlatFaces faces(const UnitShape&) { return {{{0, 1, 0}, {0, 0, 0}, {1, 0, 0}, {0, 0, 1}, true}}; }
  static std::optional<Curvature> curvature(const UnitShape&) { return std::nullopt; }
  static double distance(const UnitShape&, const dvec3& q) { return q.y; }
};

struct SphereShape {
  double radius = 1;
  dvec3 half_size() const { return dvec3(radius); }
  bool open() const { return false; }
  UnitShape unit() const {
    want_positive(radius, "radius");
    return {SHAPE_SPHERE, dvec3(radius)};
  }
  static double reach(const UnitShape&, const dvec3& d) { return glm::length(d); }
  static FlatFaces faces(const UnitShape&) { return {}; }
  static std::optional<Curvature> curvature(const UnitShape&) { return Curvature{1}; }
  static double distance(const UnitShape&, const dvec3& q) { return glm::length(q) - 1; }
};

struct BoxShape {
  dvec3 half{1, 1, 1};
  dvec3 half_size() const { return half; }
  bool open() const { return false; }
  UnitShape unit() const {
    for (int axis = 0; axis < 3; ++axis) want_positive(half[axis], "half size");
    return {SHAPE_BOX, half};
  }
  static double reach(const UnitShape&, const dvec3& d) {
    return std::abs(d.x) + std::abs(d.y) + std::abs(d.z);
  }
  static FlatFaces faces(const UnitShape&) { return box_faces(dvec3(1), 0); }
  static std::optional<Curvature> curvature(const UnitShape&) { return std::nullopt; }
  static double distance(const UnitShape&, const dvec3& q) { return box_distance(q, dvec3(1), 0); }
};

struct CylinderShape {  // about y, centred
  double radius = 1, half_height = 1;
  bool capped = true;
  dvec3 half_size() const { return {radius, half_height, radius}; }
  bool open() const { return !capped; }
  UnitShape unit() const {
    want_positive(radius, "radius");
    want_positive(half_height, "half height");
    return {SHAPE_CYLINDER, dvec3(radius, half_height, radius), {capped ? 1.0f : 0.0f, 0, 0, 0}};
  }
  static double reach(const UnitShape&, const dvec3& d) { return across(d) + std::abs(d.y); }
  static FlatFaces faces(const UnitShape& u) {
    const double cap = u.parameters.x != 0 ? 1 : 0;
    return cap_faces(cap, cap);
  }
  static std::optional<Curvature> curvature(const UnitShape&) { return Curvature{1, true}; }
  static double distance(const UnitShape&, const dvec3& q) {
    return std::max(across(q) - 1, std::abs(q.y) - 1);
  }
};

struct ConeShape {
  double bottom_radius = 1, top_radius = 0, half_height = 1;
  bool capped = true;
  dvec3 half_size() const {
    const double radius = std::max(bottom_radius, top_radius);
    return {radius, half_height, radius};
  }
  bool open() const { return !capped; }
  UnitShape unit() const {
    want(bottom_radius >= 0 && top_radius >= 0, "radii of 0 or more");
    const double widest = std::max(bottom_radius, top_radius);
    want_positive(widest, "bottom or top radius");
    want_positive(half_height, "half height");
    return {SHAPE_CONE,
            dvec3(widest, half_height, widest),
            {to_float(bottom_radius / widest), to_float(top_radius / widest), capped ? 1.0f : 0.0f, 0}};
  }
  static double reach(const UnitShape& u, const dvec3& d) {
    return std::max(double(u.parameters.x) * across(d) - d.y, double(u.parameters.y) * across(d) + d.y);
  }
  static FlatFaces faces(const UnitShape& u) {
    return u.parameters.z != 0 ? cap_faces(double(u.parameters.x), double(u.parameters.y)) : FlatFaces();
  }
  static std::optional<Curvature> curvature(const UnitShape& u) {
    const double least = double(std::min(u.parameters.x, u.parameters.y));
    return Curvature{least > 0 ? 1 / least : INFINITY};
  }
  static double distance(const UnitShape& u, const dvec3& q) {
    const double bottom = double(u.parameters.x), top = double(u.parameters.y);
    const double middle = 0.5 * (bottom + top), slope = 0.5 * (top - bottom);
    return std::max((across(q) - middle - slope * q.y) / std::hypot(1.0, slope), std::abs(q.y) - 1);
  }
};

struct DiskShape {  // in y = 0
  double radius = 1, inner_radius = 0;
  dvec3 half_size() const { return {radius, 0, radius}; }
  bool open() const { return true; }
  UnitShape unit() const {
    want_positive(radius, "radius");
    want(inner_radius >= 0 && inner_radius < radius, "an inner radius from 0 to below the radius");
    return {SHAPE_DISK, dvec3(radius), {to_float(inner_radius / radius), 0, 0, 0}};
  }
  static double reach(const UnitShape&, const dvec3& d) { return across(d); }
  static FlatFaces faces(const UnitShape&) { return {{{0, 1, 0}, {0, 0, 0}, {1, 0, 0}, {0, 0, 1}}}; }
  static std::optional<Curvature> curvature(const UnitShape&) { return std::nullopt; }
};

struct RectangleShape {  // in y = 0; half sizes along x and z
  dvec2 half{1, 1};
  dvec3 half_size() const { return {half.x, 0, half.y}; }
  bool open() const { return true; }
  UnitShape unit() const {
    for (int axis = 0; axis < 2; ++axis) want_positive(half[axis], "half size");
    return {SHAPE_RECTANGLE, {half.x, std::max(half.x, half.y), half.y}};
  }
  static double reach(const UnitShape&, const dvec3& d) { return std::abs(d.x) + std::abs(d.z); }
  static FlatFaces faces(const UnitShape& u) { return DiskShape::faces(u); }
  static std::optional<Curvature> curvature(const UnitShape&) { return std::nullopt; }
};

struct TorusShape {  // about y
  double major_radius = 1, minor_radius = 0.25;
  dvec3 half_size() const { return {major_radius + minor_radius, minor_radius, major_radius + minor_radius}; }
  bool open() const { return false; }
  UnitShape unit() const {
    want_positive(major_radius, "major radius");
    want(minor_radius > 0 && minor_radius < major_radius, "a minor radius between 0 and the major radius");
    return {SHAPE_TORUS, dvec3(major_radius), {to_float(minor_radius / major_radius), 0, 0, 0}};
  }
  static double reach(const UnitShape& u, const dvec3& d) {
    return across(d) + double(u.parameters.x) * glm::length(d);
  }
  static FlatFaces faces(const UnitShape&) { return {}; }
  static std::optional<Curvature> curvature(const UnitShape& u) {
    const double minor = double(u.parameters.x);
    return Curvature{1 / std::min(minor, 1 - minor)};
  }
  static double distance(const UnitShape& u, const dvec3& q) {
    return std::hypot(across(q) - 1, q.y) - double(u.parameters.x);
  }
};

struct RoundBoxShape {  // outer half sizes, edge radius
  dvec3 half{1, 1, 1};
  double radius = 0.1;
  dvec3 half_size() const { return half; }
  bool open() const { return false; }
  UnitShape unit() const {
    for (int axis = 0; axis < 3; ++axis) want_positive(half[axis], "half size");
    const double least = std::min({half.x, half.y, half.z}), most = std::max({half.x, half.y, half.z});
    want(radius >= 0 && radius <= least, "an edge radius from 0 to the smallest half size");
    float4 p{to_float(half.x / most), to_float(half.y / most), to_float(half.z / most),
             to_float(radius / most)};
    p.w = std::min({p.w, p.x, p.y, p.z});
    return {SHAPE_ROUNDBOX, dvec3(most), p};
  }
  static dvec3 unit_half(const UnitShape& u) { return {u.parameters.x, u.parameters.y, u.parameters.z}; }
  static double reach(const UnitShape& u, const dvec3& d) {
    const double edge = double(u.parameters.w);
    return glm::dot(unit_half(u) - edge, glm::abs(d)) + edge * glm::length(d);
  }
  static FlatFaces faces(const UnitShape& u) { return box_faces(unit_half(u), double(u.parameters.w)); }
  static std::optional<Curvature> curvature(const UnitShape& u) {
    const double edge = double(u.parameters.w);
    return edge > 0 ? std::optional(Curvature{1 / edge}) : std::nullopt;
  }
  static double distance(const UnitShape& u, const dvec3& q) {
    return box_distance(q, unit_half(u), double(u.parameters.w));
  }
};

/// A surface of revolution about y. Its outside is to the right of the profile, whose middle height is 0.
struct LatheShape {
  std::vector<ProfileCubic> profile{{{0, -1}, {0, -1}, {1, -1}, {1, -1}},
                                    {{1, -1}, {0.2, -0.4}, {0.2, 0.4}, {1, 1}},
                                    {{1, 1}, {1, 1}, {0, 1}, {0, 1}}};
  bool closed = true;  // the profile ends on the axis, or where it began, and encloses a solid
  double radius = 1, half_height = 1;
  dvec3 half_size() const { return {radius, half_height, radius}; }
  bool open() const { return !closed; }
  UnitShape unit() const {  // its profile rows begin at 0
    constexpr std::size_t most_arcs = 1024;
    const double widest = std::max(radius, half_height);
    want_positive(radius, "radius");
    auto revolution = std::make_shared<const Revolution>(profile, closed, widest);
    const std::size_t count = revolution->arcs().size();
    want(count <= most_arcs, fmt::format("a profile of at most {} arcs, found {}", most_arcs, count));
    return {SHAPE_LATHE,
            dvec3(widest),
            {0, static_cast<float>(count), to_float(radius / widest), to_float(half_height / widest)},
            std::move(revolution)};
  }
  static double reach(const UnitShape& u, const dvec3& d) { return u.revolution->reach(across(d), d.y); }
  static FlatFaces faces(const UnitShape& u) { return ring_faces(*u.revolution); }
  static std::optional<Curvature> curvature(const UnitShape& u) {
    return Curvature{u.revolution->greatest_curvature(dvec3(0), INFINITY)};
  }
  static double distance(const UnitShape& u, const dvec3& q) { return u.revolution->distance(q); }
};

}  // namespace sundog
