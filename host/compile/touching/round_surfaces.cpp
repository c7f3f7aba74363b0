// See round_surfaces.h. Cells are halved while both surfaces may pass through them side by side.
#include "compile/touching/round_surfaces.h"

#include <algorithm>
#include <cmath>

namespace sundog {
namespace {

/// A surface as its distance in unit space.
struct Surface {
  u32 shape;
  float4 p;
  dmat4 unit_from_world;
  double slope;      // greatest change of the unit distance a unit of world length
  double curvature;  // greatest, in the world
  double middle_of_cone = 0, slope_of_cone = 0;

  double distance(const dvec3& world) const {
    const dvec3 q(unit_from_world * glm::dvec4(world, 1));
    const double across = std::hypot(q.x, q.z);
    switch (shape) {
      case SHAPE_SPHERE:
        return glm::length(q) - 1;
      case SHAPE_CYLINDER:
        return std::max(across - 1, std::abs(q.y) - 1);
      case SHAPE_CONE:
        return std::max((across - middle_of_cone - slope_of_cone * q.y) / std::hypot(1.0, slope_of_cone),
                        std::abs(q.y) - 1);
      case SHAPE_TORUS:
        return std::hypot(across - 1, q.y) - double(p.x);
      default: {
        const dvec3 out = glm::abs(q) - (dvec3(p.x, p.y, p.z) - double(p.w));
        return glm::length(glm::max(out, dvec3(0))) + std::min(std::max({out.x, out.y, out.z}), 0.0) -
               double(p.w);
      }
    }
  }

  dvec3 gradient(const dvec3& world, double step) const {
    dvec3 g;
    for (int axis = 0; axis < 3; ++axis) {
      dvec3 ahead = world, behind = world;
      ahead[axis] += step, behind[axis] -= step;
      g[axis] = (distance(ahead) - distance(behind)) / (2 * step);
    }
    return g;
  }
};

bool is_round(const UnitShape& unit) {
  switch (unit.shape) {
    case SHAPE_SPHERE:
    case SHAPE_CYLINDER:
    case SHAPE_CONE:
    case SHAPE_TORUS:
      return true;
    case SHAPE_ROUNDBOX:
      return unit.parameters.w > 0;
    default:
      return false;
  }
}

/// Greatest factor by which the matrix stretches a vector, a little rounded up: powers of m^T m grow like it.
double norm(const glm::dmat3& m) {
  glm::dmat3 power = glm::transpose(m) * m;
  double scale = 0, weight = 1;
  for (int i = 0; i < 6; ++i) {
    double most = 0;
    for (int k = 0; k < 9; ++k) most = std::max(most, std::abs(power[k / 3][k % 3]));
    if (!(most > 0)) return 0;
    scale += std::log(most) * weight;
    power = power * (1 / most);
    power = power * power;
    weight /= 2;
  }
  return 1.02 * std::exp(0.5 * scale + 0.5 * weight * std::log(power[0][0] + power[1][1] + power[2][2]));
}

/// Greatest curvature in unit space; a cone's has no bound at a tip.
double unit_curvature(const UnitShape& unit) {
  switch (unit.shape) {
    case SHAPE_TORUS:
      return 1 / std::min(double(unit.parameters.x), 1 - double(unit.parameters.x));
    case SHAPE_ROUNDBOX:
      return 1 / double(unit.parameters.w);
    case SHAPE_CONE: {
      const double least = std::min(double(unit.parameters.x), double(unit.parameters.y));
      return least > 0 ? 1 / least : INFINITY;
    }
    default:
      return 1;
  }
}

Surface make_surface(const RoundSolid& solid) {
  const dmat4 inverse = glm::inverse(solid.world_from_unit);
  const double shrinks = norm(glm::dmat3(inverse));
  // A cylinder's length bends nothing.
  glm::dmat3 across(solid.world_from_unit), back(inverse);
  if (solid.unit.shape == SHAPE_CYLINDER) {
    across[1] = dvec3(0);
    for (int column = 0; column < 3; ++column) back[column].y = 0;
  }
  Surface surface{solid.unit.shape, solid.unit.parameters, inverse, shrinks,
                  unit_curvature(solid.unit) * norm(back) * norm(back) * norm(across)};
  surface.middle_of_cone = 0.5 * (double(surface.p.x) + double(surface.p.y));
  surface.slope_of_cone = 0.5 * (double(surface.p.y) - double(surface.p.x));
  return surface;
}

struct CellSearch {
  const Surface &a, &b;
  double tolerance, least;  // radius of a cell in which nothing more is asked
  int cells_left = 40000;

  /// Whether the surfaces may run side by side in the cell.
  bool may_touch(const dvec3& center, double radius) const {
    const double at_a = a.distance(center), at_b = b.distance(center);
    if (std::abs(at_a) > a.slope * (radius + tolerance) || std::abs(at_b) > b.slope * (radius + tolerance))
      return false;
    const double step = 1e-4 * radius;
    const dvec3 up_a = a.gradient(center, step), up_b = b.gradient(center, step);
    const double steep_a = glm::length(up_a), steep_b = glm::length(up_b);
    if (!(steep_a > 0) || !(steep_b > 0)) return true;
    const double sine = glm::length(glm::cross(up_a, up_b)) / (steep_a * steep_b);
    const double bend = (a.curvature + b.curvature) * radius;
    if (sine > 0.02 + 2 * bend) return false;
    const double side = glm::dot(up_a, up_b) < 0 ? -1 : 1;
    const double gap = std::abs(at_a / steep_a - side * at_b / steep_b);
    return !(gap > tolerance + radius * (sine + bend));
  }

  bool run(const dvec3& center, const dvec3& half) {
    const double radius = glm::length(half);
    if (!may_touch(center, radius)) return false;
    if (radius <= least || --cells_left < 0) return true;
    const int axis = half.x >= half.y && half.x >= half.z ? 0 : half.y >= half.z ? 1 : 2;
    dvec3 smaller = half, shift(0);
    smaller[axis] *= 0.5;
    shift[axis] = smaller[axis];
    return run(center - shift, smaller) || run(center + shift, smaller);
  }
};

}  // namespace

bool round_surfaces_touch(const RoundSolid& a, const RoundSolid& b, const Bounds& box, double tolerance) {
  if (!is_round(a.unit) || !is_round(b.unit)) return false;
  const dvec3 lower(box.lower[0], box.lower[1], box.lower[2]),
      upper(box.upper[0], box.upper[1], box.upper[2]);
  const dvec3 half = 0.5 * glm::max(upper - lower, dvec3(0)) + tolerance;
  const Surface of_a = make_surface(a), of_b = make_surface(b);
  CellSearch search{of_a, of_b, tolerance, 4 * tolerance + 1e-3 * glm::length(half)};
  return search.run(0.5 * (lower + upper), half);
}

}  // namespace sundog
