// Compares spheres in closed form; for other pairs, halves cells in which both surfaces may pass nearly
// parallel, in a half plane if they share an axis.
#include "compile/touching/round_surfaces.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace sundog {
namespace {

/// A surface given by its unit-space distance.
struct Surface {
  UnitShape unit;
  dmat4 unit_from_world;
  double slope;      // maximum change of the unit distance per world length
  double curvature;  // maximum, in the world
  double bends;      // maximum ratio of curvature in the world to curvature in unit space

  /// The maximum curvature within a ball.
  double curvature_near(const dvec3& world, double radius) const {
    if (!unit.revolution) return curvature;
    const dvec3 center(unit_from_world * glm::dvec4(world, 1));
    return bends * unit.revolution->greatest_curvature(center, slope * radius);
  }

  double distance(const dvec3& world) const {
    return unit_distance(unit, dvec3(unit_from_world * glm::dvec4(world, 1)));
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

/// The spectral norm, slightly overestimated, from powers of m^T m.
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

Surface make_surface(const RoundSolid& solid, const Curvature& bends) {
  const dmat4 inverse = glm::inverse(solid.world_from_unit);
  const double shrinks = norm(glm::dmat3(inverse));
  glm::dmat3 across(solid.world_from_unit), back(inverse);
  if (bends.straight_y) {
    across[1] = dvec3(0);
    for (int column = 0; column < 3; ++column) back[column].y = 0;
  }
  const double more = norm(back) * norm(back) * norm(across);
  return {solid.unit, inverse, shrinks, bends.greatest * more, more};
}

constexpr double least_sine = 0.02;  // a larger sine of their angle means that surfaces cross

struct Ball {
  dvec3 center;
  double radius;
};

/// The solid as a ball, if it is a uniformly scaled sphere.
std::optional<Ball> as_ball(const RoundSolid& solid) {
  if (solid.unit.shape != SHAPE_SPHERE) return std::nullopt;
  const glm::dmat3 linear(solid.world_from_unit);
  const double square = glm::dot(linear[0], linear[0]);
  for (int i = 0; i < 3; ++i)
    if (!(std::abs(glm::dot(linear[i], linear[i]) - square) <= 1e-9 * square &&
          std::abs(glm::dot(linear[i], linear[(i + 1) % 3])) <= 1e-9 * square))
      return std::nullopt;
  return Ball{dvec3(solid.world_from_unit[3]), std::sqrt(square)};
}

/// Whether the balls' surfaces stay farther apart than the tolerance or cross at an angle.
bool part_or_cross(const Ball& a, const Ball& b, double tolerance) {
  const double apart = glm::distance(a.center, b.center), both = a.radius + b.radius;
  const double nested = std::abs(a.radius - b.radius);
  if (apart > both + 4 * tolerance || apart < nested - 4 * tolerance) return true;
  const double cosine =
      (a.radius * a.radius + b.radius * b.radius - apart * apart) / (2 * a.radius * b.radius);
  return std::sqrt(std::max(1 - cosine * cosine, 0.0)) > least_sine;
}

struct CellSearch {
  const Surface &a, &b;
  double tolerance, least;  // cell radius at which subdivision stops
  int cells_left = 40000;

  /// Whether the surfaces may be nearly parallel and close in the cell.
  bool may_touch(const dvec3& center, double radius) const {
    const double at_a = a.distance(center), at_b = b.distance(center);
    if (std::abs(at_a) > a.slope * (radius + tolerance) || std::abs(at_b) > b.slope * (radius + tolerance))
      return false;
    const double step = 1e-4 * radius;
    const dvec3 up_a = a.gradient(center, step), up_b = b.gradient(center, step);
    const double steep_a = glm::length(up_a), steep_b = glm::length(up_b);
    if (!(steep_a > 0) || !(steep_b > 0)) return true;
    const double sine = glm::length(glm::cross(up_a, up_b)) / (steep_a * steep_b);
    const double bend =
        (a.curvature_near(center, 2 * radius) + b.curvature_near(center, 2 * radius)) * radius;
    if (sine > least_sine + 2 * bend) return false;
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

/// If both solids revolve about one axis and one of them is a lathe, places the second in the first's unit
/// space.
std::optional<dmat4> about_one_axis(const RoundSolid& a, const RoundSolid& b) {
  const auto revolves = [](const RoundSolid& solid) {
    const ShapeKind shape = solid.unit.shape;
    return solid.unit.revolution || shape == SHAPE_SPHERE || shape == SHAPE_CYLINDER || shape == SHAPE_CONE ||
           shape == SHAPE_TORUS;
  };
  if (!(a.unit.revolution || b.unit.revolution) || !revolves(a) || !revolves(b)) return std::nullopt;
  const dmat4 relative = glm::inverse(a.world_from_unit) * b.world_from_unit;
  const dvec3 x(relative[0]), y(relative[1]), z(relative[2]), at(relative[3]);
  const double size = glm::length(x), least = 1e-9 * (size + glm::length(y) + glm::length(at));
  const bool same = std::abs(x.y) < least && std::abs(z.y) < least && std::abs(y.x) < least &&
                    std::abs(y.z) < least && std::abs(at.x) < least && std::abs(at.z) < least;
  if (!same || std::abs(glm::length(z) - size) > least || std::abs(glm::dot(x, z)) > least * size)
    return std::nullopt;
  return relative;
}

}  // namespace

bool round_surfaces_touch(const RoundSolid& a, const RoundSolid& b, const Bounds& box, double tolerance) {
  const auto bends_a = curvature(a.unit), bends_b = curvature(b.unit);
  if (!bends_a || !bends_b) return false;
  const auto ball_a = as_ball(a), ball_b = as_ball(b);
  if (ball_a && ball_b) return !part_or_cross(*ball_a, *ball_b, tolerance);
  if (const auto relative = about_one_axis(a, b)) {  // one half plane suffices
    const double slack = tolerance * norm(glm::dmat3(glm::inverse(a.world_from_unit)));
    const Surface of_a = make_surface({a.unit, dmat4(1)}, *bends_a),
                  of_b = make_surface({b.unit, *relative}, *bends_b);
    const double reach_x = reach(a.unit, {1, 0, 0}), top = reach(a.unit, {0, 1, 0}),
                 bottom = -reach(a.unit, {0, -1, 0});
    const dvec3 half = 0.5 * dvec3(reach_x, top - bottom, 0) + dvec3(slack, slack, 0);
    CellSearch search{of_a, of_b, slack, 4 * slack + 1e-6 * glm::length(half)};
    return search.run({reach_x / 2, (top + bottom) / 2, 0}, half);
  }
  const dvec3 lower(box.lower[0], box.lower[1], box.lower[2]),
      upper(box.upper[0], box.upper[1], box.upper[2]);
  const dvec3 half = 0.5 * glm::max(upper - lower, dvec3(0)) + tolerance;
  const double least = 4 * tolerance + 1e-3 * glm::length(half);
  const Surface of_a = make_surface(a, *bends_a), of_b = make_surface(b, *bends_b);
  CellSearch search{of_a, of_b, tolerance, least};
  return search.run(0.5 * (lower + upper), half);
}

}  // namespace sundog
