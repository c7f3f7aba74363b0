// See exact_solids.h.
#include "bench/rays/exact_solids.h"

#include <algorithm>
#include <cmath>

namespace sundog {
namespace {

using glm::dvec3;
using Roots = std::vector<double>;

template <class Function>
double bisect(const Function& f, double a, double b) {
  const bool rising = f(a) < f(b);
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (a + b);
    if (middle == a || middle == b) break;
    ((f(middle) < 0) == rising ? a : b) = middle;
  }
  return 0.5 * (a + b);
}

/// Real roots in [a, b] of the polynomial (lowest coefficient first): between the roots of its derivative it
/// is monotonic.
Roots polynomial_roots(const std::vector<double>& c, double a, double b) {
  if (c.size() < 2) return {};
  std::vector<double> derivative;
  for (std::size_t i = 1; i < c.size(); ++i) derivative.push_back(c[i] * static_cast<double>(i));
  Roots bounds = polynomial_roots(derivative, a, b);
  bounds.insert(bounds.begin(), a);
  bounds.push_back(b);
  const auto value = [&](double t) {
    double sum = 0;
    for (std::size_t i = c.size(); i-- > 0;) sum = sum * t + c[i];
    return sum;
  };
  Roots roots;
  for (std::size_t i = 0; i + 1 < bounds.size(); ++i)
    if ((value(bounds[i]) < 0) != (value(bounds[i + 1]) < 0))
      roots.push_back(bisect(value, bounds[i], bounds[i + 1]));
  return roots;
}

/// Roots of a t^2 + 2 h t + c.
Roots quadratic(double a, double h, double c) {
  if (a == 0) return h == 0 ? Roots{} : Roots{-c / (2 * h)};
  const double inside = h * h - a * c;
  if (inside < 0) return {};
  const double q = -(h + std::copysign(std::sqrt(inside), h));
  return q == 0 ? Roots{0} : Roots{q / a, c / q};
}

struct Line {
  dvec3 o, d;
  std::vector<SolidCrossing> found;

  dvec3 at(double t) const { return o + t * d; }
  void add(double t, const dvec3& ng) { found.push_back({t, ng}); }

  void sphere() {
    for (const double t : quadratic(glm::dot(d, d), glm::dot(o, d), glm::dot(o, o) - 1)) add(t, at(t));
  }

  void box() {
    for (int axis = 0; axis < 3; ++axis)
      for (const double side : {-1.0, 1.0}) {
        if (d[axis] == 0) continue;
        const double t = (side - o[axis]) / d[axis];
        const dvec3 p = at(t);
        const int b = (axis + 1) % 3, c = (axis + 2) % 3;
        dvec3 ng(0);
        ng[axis] = side;
        if (std::abs(p[b]) <= 1 && std::abs(p[c]) <= 1) add(t, ng);
      }
  }

  /// The part of the plane y = height between two radii.
  void disk(double height, double inner, double outer, double up) {
    if (d.y == 0) return;
    const double t = (height - o.y) / d.y;
    const dvec3 p = at(t);
    const double r = std::hypot(p.x, p.z);
    if (r <= outer && r >= inner) add(t, dvec3(0, up, 0));
  }

  void rectangle() {
    if (d.y == 0) return;
    const double t = -o.y / d.y;
    const dvec3 p = at(t);
    if (std::max(std::abs(p.x), std::abs(p.z)) <= 1) add(t, dvec3(0, 1, 0));
  }

  /// The side of a cone of radius middle + slope y, for y in [-1, 1].
  void side(double middle, double slope) {
    const double r = middle + slope * o.y, dr = slope * d.y;
    for (const double t : quadratic(d.x * d.x + d.z * d.z - dr * dr, o.x * d.x + o.z * d.z - r * dr,
                                    o.x * o.x + o.z * o.z - r * r)) {
      const dvec3 p = at(t);
      const double radius = middle + slope * p.y;
      if (std::abs(p.y) <= 1 && radius >= 0) add(t, dvec3(p.x, -slope * radius, p.z));
    }
  }

  /// Torus: (|p|^2 + 1 - r^2)^2 = 4 (x^2 + z^2), as a quartic around the point nearest to the centre.
  void torus(double minor) {
    const double length2 = glm::dot(d, d), shift = -glm::dot(o, d) / length2;
    const dvec3 q = at(shift);
    const double a = length2, k = glm::dot(q, q) + 1 - minor * minor;
    const double across_dd = d.x * d.x + d.z * d.z, across_qd = q.x * d.x + q.z * d.z,
                 across_qq = q.x * q.x + q.z * q.z;
    const double end = 3 / std::sqrt(length2);
    for (const double s : polynomial_roots(
             {k * k - 4 * across_qq, -8 * across_qd, 2 * a * k - 4 * across_dd, 0, a * a}, -end, end)) {
      const dvec3 p = q + s * d;
      const double across = std::hypot(p.x, p.z);
      add(s + shift, p - dvec3(p.x, 0, p.z) / across);
    }
  }

  /// A rounded box is convex and its distance is convex along a line: the least distance, then a root on each
  /// side.
  void round_box(const dvec3& half, double radius) {
    const auto outside = [&](double t) {
      return glm::max(glm::abs(at(t)) - (half - radius), dvec3(-radius));
    };
    const auto distance = [&](double t) {
      const dvec3 e = outside(t);
      return glm::length(glm::max(e, dvec3(0))) + std::min(std::max({e.x, e.y, e.z}), 0.0) - radius;
    };
    const double nearest = -glm::dot(o, d) / glm::dot(d, d), end = 2 * glm::length(half) / glm::length(d);
    double a = nearest - end, b = nearest + end;
    for (int i = 0; i < 200; ++i) {
      const double third = (b - a) / 3;
      (distance(a + third) < distance(b - third) ? b : a) =
          distance(a + third) < distance(b - third) ? b - third : a + third;
    }
    const double deepest = 0.5 * (a + b);
    if (!(distance(deepest) < 0)) return;
    for (const double t :
         {bisect(distance, nearest - end, deepest), bisect(distance, deepest, nearest + end)}) {
      const dvec3 p = at(t), e = glm::abs(p) - (half - radius);
      dvec3 ng = glm::sign(p) * glm::max(e, dvec3(0));
      if (ng == dvec3(0)) {  // sharp edges: the face that is nearest
        const int axis = e.x >= e.y && e.x >= e.z ? 0 : e.y >= e.z ? 1 : 2;
        ng[axis] = p[axis];
      }
      add(t, ng);
    }
  }
};

}  // namespace

std::vector<SolidCrossing> solid_crossings(u32 shape, const float4& parameters, const glm::dvec3& o,
                                           const glm::dvec3& d) {
  Line line{o, d, {}};
  const double x = double(parameters.x), y = double(parameters.y), z = double(parameters.z),
               w = double(parameters.w);
  switch (shape) {
    case SHAPE_SPHERE:
      line.sphere();
      break;
    case SHAPE_PLANE:
      if (d.y != 0) line.add(-o.y / d.y, dvec3(0, 1, 0));
      break;
    case SHAPE_BOX:
      line.box();
      break;
    case SHAPE_CYLINDER:
      line.side(1, 0);
      if (x != 0) line.disk(-1, 0, 1, -1), line.disk(1, 0, 1, 1);
      break;
    case SHAPE_CONE:
      line.side(0.5 * (x + y), 0.5 * (y - x));
      if (z != 0) line.disk(-1, 0, x, -1), line.disk(1, 0, y, 1);
      break;
    case SHAPE_DISK:
      line.disk(0, x, 1, 1);
      break;
    case SHAPE_RECTANGLE:
      line.rectangle();
      break;
    case SHAPE_TORUS:
      line.torus(x);
      break;
    case SHAPE_ROUNDBOX:
      line.round_box(dvec3(x, y, z), w);
      break;
    default:
      return crossings_by_distance({static_cast<ShapeKind>(shape), dvec3(1), parameters}, o, d);
  }
  std::sort(line.found.begin(), line.found.end(), [](const auto& a, const auto& b) { return a.t < b.t; });
  return line.found;
}

}  // namespace sundog
