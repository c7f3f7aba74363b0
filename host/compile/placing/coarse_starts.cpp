// Computes how far rays start off a surface (kernels/plain/shade/interaction.cl), at each solid's nearest
// point and each mesh's worst triangle, and compares that with the camera's distance.
#include "compile/placing/coarse_starts.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include "compile/shapes.h"

namespace sundog {
namespace {

constexpr double spacing = 0x1p-21, scene_spacing = 0x1p-19;  // as in interaction.cl
constexpr double most_share = 0.01;                           // of the camera's distance

double greatest_of(const dvec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

/// The camera and the tables' origin in an object's space.
struct Seen {
  glm::dmat3 normals;  // from object to world space
  dvec3 camera, origin;

  Seen(const glm::dmat4& world_from_unit, const dvec3& from, const dvec3& tables) {
    const glm::dmat4 back = glm::inverse(world_from_unit);
    normals = glm::transpose(glm::dmat3(back));
    camera = dvec3(back * glm::dvec4(from, 1));
    origin = dvec3(back * glm::dvec4(tables, 1));
  }
  /// Converts a length along a unit normal.
  double in_world(double length, const dvec3& normal) const { return length / glm::length(normals * normal); }
};

double distance_of(const UnitShape& unit, const dvec3& q) {
  if (unit.shape == SHAPE_DISK) return std::hypot(std::max(std::hypot(q.x, q.z) - 1, 0.0), q.y);
  if (unit.shape != SHAPE_RECTANGLE) return std::abs(unit_distance(unit, q));
  return glm::length(glm::max(glm::abs(q) - dvec3(1, 0, 1), dvec3(0)));
}

/// The unit direction away from a solid's surface.
dvec3 away_from(const UnitShape& unit, const dvec3& q) {
  const double step = 1e-4 * std::max(1.0, greatest_of(q));
  dvec3 slope(0);
  for (int axis = 0; axis < 3; ++axis) {
    dvec3 aside(0);
    aside[axis] = step;
    slope[axis] = distance_of(unit, q + aside) - distance_of(unit, q - aside);
  }
  return greatest_of(slope) > 1e-3 * step ? glm::normalize(slope) : dvec3(0, 1, 0);
}

CoarseStart start_on_solid(const UnitShape& unit, const Seen& seen) {
  const dvec3 normal = away_from(unit, seen.camera);
  const bool flat = unit.shape == SHAPE_PLANE || unit.shape == SHAPE_DISK || unit.shape == SHAPE_RECTANGLE;
  const double size = flat ? 0 : 1;
  const double rounding = spacing * greatest_of(normal * (glm::abs(seen.origin) + size));
  return {{}, seen.in_world(rounding, normal), seen.in_world(distance_of(unit, seen.camera), normal)};
}

/// On the triangle with the largest offset relative to its distance.
CoarseStart start_on_mesh(const Mesh& mesh, const Seen& seen) {
  CoarseStart worst{{}, 0, std::numeric_limits<double>::infinity()};
  const double scale = 1 / std::cbrt(std::abs(glm::determinant(seen.normals)));
  for (const glm::uvec3& corners : mesh.triangles) {
    const glm::vec3 &a = mesh.positions[corners.x], &b = mesh.positions[corners.y],
                    &c = mesh.positions[corners.z];
    const dvec3 low(glm::min(glm::min(a, b), c)), high(glm::max(glm::max(a, b), c));
    const double away = scale * spacing * std::max(greatest_of(high - low), greatest_of(seen.origin));
    const dvec3 beside = glm::max(glm::max(low - seen.camera, seen.camera - high), dvec3(0));
    const double distance = scale * glm::length(beside);
    if (away * worst.distance > worst.away * distance) worst = {{}, away, distance};
  }
  return worst;
}

/// Whether some triangle can be so large, or so far from its mesh's origin, that all must be tested.
bool may_be_coarse(const Mesh& mesh, const Seen& seen, double least) {
  glm::vec3 low(std::numeric_limits<float>::infinity()), high = -low;
  for (const glm::vec3& p : mesh.positions) low = glm::min(low, p), high = glm::max(high, p);
  const double scale = 1 / std::cbrt(std::abs(glm::determinant(seen.normals)));
  return scale * spacing * std::max(greatest_of(dvec3(high) - dvec3(low)), greatest_of(seen.origin)) > least;
}

}  // namespace

std::vector<CoarseStart> coarse_starts(const SceneDescription& scene, const dvec3& origin) {
  const Camera& camera = scene.camera;
  // The offset that rounding at the camera's position requires anyway; smaller ones do not matter.
  const double least = scene_spacing * greatest_of(camera.position - origin);
  std::vector<CoarseStart> found;
  for (const Object& object : scene.objects) {
    if (std::holds_alternative<FieldShape>(object.shape)) continue;
    const UnitShape unit = unit_shape(scene.file.string(), object);
    const Seen seen(glm::scale(object.world_from_object, unit.scale), camera.position, origin);
    CoarseStart start;
    if (const auto* shape = std::get_if<MeshShape>(&object.shape)) {
      const Mesh& mesh = scene.meshes[static_cast<std::size_t>(shape->mesh)];
      if (!may_be_coarse(mesh, seen, least)) continue;
      start = start_on_mesh(mesh, seen);
    } else {
      start = start_on_solid(unit, seen);
    }
    if (!(start.away > std::max(least, most_share * start.distance))) continue;
    start.object = object.name.empty() ? object.place : object.name;
    found.push_back(start);
  }
  return found;
}

}  // namespace sundog
