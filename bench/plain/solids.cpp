// Solves each solid's equation in templates over the precision, and leaves solids without one to any_solid.h.
#include "bench/plain/solids.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "bench/plain/any_solid.h"

namespace sundog::plain {
namespace {

template <class T>
using Vec3 = glm::vec<3, T>;

template <class T>
struct Interval {
  T in = 0, out = 0;
};

/// The line o + t d. Finds the nearest crossing in (t_min, t_max], or appends every one to `all`.
template <class T>
struct Search {
  Vec3<T> o, d;
  T t_min = 0, t_max = 0;  // t_max shrinks to the nearest crossing
  std::vector<SolidCrossing>* all = nullptr;
  Vec3<T> ng{0};
  bool found = false;

  /// False: a later crossing of the same convex surface may count.
  bool offer(T t, const Vec3<T>& normal) {
    if (all) all->push_back({t, normal});
    if (all || !(t > t_min && t <= t_max)) return false;
    t_max = t;
    ng = normal;
    return found = true;
  }
  Vec3<T> at(T t) const { return o + t * d; }
};

/// The interval of t in which the line is within `radius` of the origin.
template <class T>
std::optional<Interval<T>> round_interval(const Vec3<T>& o, const Vec3<T>& d, T radius) {
  const T a = glm::dot(d, d);
  if (!(a > 0)) return {};
  const T b = -glm::dot(o, d);
  const Vec3<T> nearest = o + (b / a) * d;
  const T left = radius * radius - glm::dot(nearest, nearest);
  if (left < 0) return {};
  const T q = b + std::copysign(std::sqrt(a * left), b);
  const T t0 = q != 0 ? (glm::dot(o, o) - radius * radius) / q : 0, t1 = q / a;
  return Interval<T>{std::min(t0, t1), std::max(t0, t1)};
}

template <class T>
struct BoxCrossing {
  Interval<T> t{-std::numeric_limits<T>::infinity(), std::numeric_limits<T>::infinity()};
  int axis_in = 0, axis_out = 0;
};

template <class T>
std::optional<BoxCrossing<T>> box_crossing(const Vec3<T>& o, const Vec3<T>& d, const Vec3<T>& half) {
  BoxCrossing<T> box;
  for (int i = 0; i < 3; ++i) {
    if (d[i] == 0) {
      if (std::abs(o[i]) > half[i]) return {};
      continue;
    }
    const T side = std::copysign(half[i], d[i]);
    const T in = (-side - o[i]) / d[i], out = (side - o[i]) / d[i];
    if (in > box.t.in) box.t.in = in, box.axis_in = i;
    if (out < box.t.out) box.t.out = out, box.axis_out = i;
  }
  if (box.t.in > box.t.out) return {};
  return box;
}

template <class T>
void sphere(Search<T>& search) {
  const auto t = round_interval(search.o, search.d, T(1));
  if (t && !search.offer(t->in, search.at(t->in))) search.offer(t->out, search.at(t->out));
}

template <class T>
void plane(Search<T>& search) {
  if (search.d.y != 0) search.offer(-search.o.y / search.d.y, {0, 1, 0});
}

template <class T>
void box(Search<T>& search) {
  const auto crossing = box_crossing(search.o, search.d, Vec3<T>(1));
  if (!crossing) return;
  Vec3<T> in(0), out(0);
  in[crossing->axis_in] = -std::copysign(T(1), search.d[crossing->axis_in]);
  out[crossing->axis_out] = std::copysign(T(1), search.d[crossing->axis_out]);
  if (!search.offer(crossing->t.in, in)) search.offer(crossing->t.out, out);
}

/// inner <= radius <= outer in the plane y = height; the normal is (0, side, 0).
template <class T>
void ring(Search<T>& search, T height, T inner, T outer, T side) {
  if (search.d.y == 0) return;
  const T t = (height - search.o.y) / search.d.y;
  const Vec3<T> p = search.at(t);
  const T r2 = p.x * p.x + p.z * p.z;
  if (r2 <= outer * outer && r2 >= inner * inner) search.offer(t, {0, side, 0});
}

template <class T>
void rectangle(Search<T>& search) {
  if (search.d.y == 0) return;
  const T t = -search.o.y / search.d.y;
  const Vec3<T> p = search.at(t);
  if (std::max(std::abs(p.x), std::abs(p.z)) <= 1) search.offer(t, {0, 1, 0});
}

template <class T>
void cylinder(Search<T>& search, const float4& parameters) {
  const Vec3<T> flat(1, 0, 1);
  if (const auto t = round_interval(search.o * flat, search.d * flat, T(1)))
    for (const T root : {t->in, t->out})
      if (const Vec3<T> p = search.at(root); std::abs(p.y) <= 1) search.offer(root, p * flat);
  if (parameters.x == 0) return;
  ring<T>(search, 1, 0, 1, 1);
  ring<T>(search, -1, 0, 1, -1);
}

/// The side: x^2 + z^2 = (m + k y)^2, |y| <= 1.
template <class T>
void cone(Search<T>& search, const float4& parameters) {
  const T x = parameters.x, y = parameters.y, m = T(0.5) * (x + y), k = T(0.5) * (y - x);
  const Vec3<T>& d = search.d;
  const T shift = -glm::dot(search.o, d) / glm::dot(d, d);
  const Vec3<T> s = search.at(shift);
  const T ro = m + k * s.y, rd = k * d.y;
  const T a = d.x * d.x + d.z * d.z - rd * rd, b = s.x * d.x + s.z * d.z - ro * rd,
          c = s.x * s.x + s.z * s.z - ro * ro;
  if (const T discriminant = b * b - a * c; discriminant >= 0) {
    const T q = -(b + std::copysign(std::sqrt(discriminant), b));
    const T t0 = q != 0 ? c / q : 0;
    for (const T t : {t0, a != 0 ? q / a : t0}) {
      const Vec3<T> p = s + t * d;
      const T r = m + k * p.y;
      if (std::abs(p.y) <= 1 && r >= 0) search.offer(t + shift, {p.x, -k * r, p.z});
    }
  }
  if (parameters.z == 0) return;
  ring<T>(search, 1, 0, y, 1);
  ring<T>(search, -1, 0, x, -1);
}

template <class T, std::size_t N>
using Polynomial = std::array<T, N>;  // lowest power first

template <class T, std::size_t N>
T value(const Polynomial<T, N>& c, T x) {
  T sum = c[N - 1];
  for (std::size_t i = N - 1; i-- > 0;) sum = sum * x + c[i];
  return sum;
}

/// Roots in [low, high], ascending: a polynomial is monotone between the roots of its derivative.
template <class T, std::size_t N>
int roots_within(const Polynomial<T, N>& c, int degree, T low, T high, std::array<T, N>& roots) {
  if (degree == 0) return 0;
  Polynomial<T, N> derivative{};
  for (std::size_t i = 1; i < N; ++i) derivative[i - 1] = static_cast<T>(i) * c[i];
  std::array<T, N> turns{};
  const int turn_count = roots_within(derivative, degree - 1, low, high, turns);
  int found = 0;
  T a = low;
  for (int i = 0; i <= turn_count; ++i) {
    const T b = i < turn_count ? turns[static_cast<std::size_t>(i)] : high;
    T left = a, right = b;
    a = b;
    if ((value(c, left) < 0) == (value(c, right) < 0)) continue;
    const bool rising = value(c, right) > value(c, left);
    T x = T(0.5) * (left + right);
    for (int step = 0; step < 80; ++step) {
      const T f = value(c, x), slope = value(derivative, x);
      ((f > 0) == rising ? right : left) = x;
      const T newton = slope != 0 ? x - f / slope : left;
      const T next = newton > left && newton < right ? newton : T(0.5) * (left + right);
      if (next == x) break;
      x = next;
    }
    roots[static_cast<std::size_t>(found++)] = x;
  }
  return found;
}

/// (|p|^2 + 1 - r^2)^2 = 4 (x^2 + z^2).
template <class T>
void torus(Search<T>& search, const float4& parameters) {
  const T r = parameters.x, length = glm::length(search.d);
  const Vec3<T> e = search.d / length;
  const T shift = -glm::dot(search.o, e);
  const Vec3<T> s = search.o + shift * e;
  const T reach2 = (1 + r) * (1 + r) - glm::dot(s, s);
  if (!(reach2 > 0)) return;
  const T g = glm::dot(s, s) + 1 - r * r, reach = std::sqrt(reach2);
  const Polynomial<T, 5> quartic{g * g - 4 * (s.x * s.x + s.z * s.z), -8 * (s.x * e.x + s.z * e.z),
                                 2 * g - 4 * (e.x * e.x + e.z * e.z), 0, 1};
  std::array<T, 5> roots{};
  const int count = roots_within(quartic, 4, -reach, reach, roots);
  for (int i = 0; i < count; ++i) {
    const T x = roots[static_cast<std::size_t>(i)];
    const Vec3<T> p = s + x * e;
    const T inward = 1 - 1 / std::max(std::sqrt(p.x * p.x + p.z * p.z), T(1e-12));
    search.offer((x + shift) / length, {p.x * inward, p.y, p.z * inward});
  }
}

template <class T>
Polynomial<T, 7> product(const Polynomial<T, 4>& a, const Polynomial<T, 4>& b) {
  Polynomial<T, 7> sum{};
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t k = 0; k < 4; ++k) sum[i + k] += a[i] * b[k];
  return sum;
}

/// Refines t on the line and u on the arc to their common point, by Newton's method.
template <class T>
void meet_arc(const Search<T>& search, const Polynomial<T, 4>& r, const Polynomial<T, 4>& y, T& t, T& u) {
  for (int i = 0; i < 4; ++i) {
    const Vec3<T> p = search.at(t);
    const T off = p.x * p.x + p.z * p.z - value(r, u) * value(r, u), high = p.y - value(y, u);
    const T dt = 2 * (p.x * search.d.x + p.z * search.d.z),
            du = -2 * value(r, u) * (r[1] + u * (2 * r[2] + 3 * u * r[3]));
    const T dy = search.d.y, dh = -(y[1] + u * (2 * y[2] + 3 * u * y[3]));
    const T determinant = dt * dh - du * dy;
    if (std::abs(determinant) < T(1e-12)) return;
    t -= (off * dh - du * high) / determinant;
    u -= (dt * high - off * dy) / determinant;
  }
}

/// At the height of the arc's point u, the line's distance from the axis must equal the arc's radius:
/// multiplied by d.y^2, a polynomial of degree 6 in u.
template <class T>
void profile_arc(Search<T>& search, const ProfileArc& arc) {
  const Polynomial<T, 4> r{arc.r.x, arc.r.y, arc.r.z, arc.r.w}, y{arc.y.x, arc.y.y, arc.y.z, arc.y.w};
  const Vec3<T>&o = search.o, &d = search.d;
  const auto offer = [&](T t, T u) {
    meet_arc(search, r, y, t, u);
    if (!(u >= 0 && u < 1)) return;
    const Vec3<T> p = search.at(t);
    const T rho = std::max(std::hypot(p.x, p.z), T(1e-30));
    const T rise = y[1] + u * (2 * y[2] + 3 * u * y[3]), widen = r[1] + u * (2 * r[2] + 3 * u * r[3]);
    search.offer(t, {rise * p.x / rho, -widen, rise * p.z / rho});
  };
  if (std::abs(d.y) < T(1e-9) * glm::length(d)) {
    std::array<T, 4> roots{};
    Polynomial<T, 4> high = y;
    high[0] -= o.y;
    const int count = roots_within(high, 3, T(0), T(1), roots);
    const Vec3<T> flat(1, 0, 1);
    for (int i = 0; i < count; ++i) {
      const T u = roots[static_cast<std::size_t>(i)];
      if (const auto t = round_interval(o * flat, d * flat, value(r, u))) offer(t->in, u), offer(t->out, u);
    }
    return;
  }
  Polynomial<T, 4> x, z, wide;
  for (std::size_t i = 0; i < 4; ++i) {
    const T height = y[i] - (i == 0 ? o.y : T(0));
    x[i] = height * d.x + (i == 0 ? o.x * d.y : T(0));
    z[i] = height * d.z + (i == 0 ? o.z * d.y : T(0));
    wide[i] = r[i] * d.y;
  }
  Polynomial<T, 7> both = product(x, x), roots{};
  const Polynomial<T, 7> across = product(z, z), radius = product(wide, wide);
  for (std::size_t i = 0; i < 7; ++i) both[i] += across[i] - radius[i];
  const int count = roots_within(both, 6, T(-1e-6), T(1 + 1e-6), roots);
  for (int i = 0; i < count; ++i) {
    const T u = roots[static_cast<std::size_t>(i)];
    offer((value(y, u) - o.y) / d.y, u);
  }
}

template <class T>
void lathe(Search<T>& search, const Solid& solid) {
  const auto first = static_cast<std::size_t>(solid.parameters.x),
             count = static_cast<std::size_t>(solid.parameters.y);
  for (const ProfileArc& arc : solid.profiles.subspan(first, count)) profile_arc(search, arc);
}

/// Widens `span` by the entry and exit of one of the solids whose union is the rounded box.
template <class T>
void widen(Interval<T>& span, const Interval<T>& t) {
  span = {std::min(span.in, t.in), std::max(span.out, t.out)};
}

/// Three boxes, twelve cylinders along the edges and eight spheres at the corners; their union is convex.
template <class T>
void round_box(Search<T>& search, const float4& parameters) {
  const Vec3<T> half(parameters.x, parameters.y, parameters.z);
  const T r = parameters.w;
  const Vec3<T> core = half - r, &o = search.o, &d = search.d;
  if (!box_crossing(o, d, half)) return;
  Interval<T> span{std::numeric_limits<T>::infinity(), -std::numeric_limits<T>::infinity()};
  for (int axis = 0; axis < 3; ++axis) {
    Vec3<T> slab = core;
    slab[axis] = half[axis];
    if (const auto crossing = box_crossing(o, d, slab)) widen(span, crossing->t);
  }
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3<T> c = o - core * Vec3<T>(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
    if (const auto t = round_interval(c, d, r)) widen(span, *t);
    for (int axis = 0; axis < 3; ++axis) {
      if (corner >> axis & 1) continue;  // each edge once
      Vec3<T> keep(1);
      keep[axis] = 0;
      const auto t = round_interval(c * keep, d * keep, r);
      if (t && std::abs(search.at(t->in)[axis]) <= core[axis]) span.in = std::min(span.in, t->in);
      if (t && std::abs(search.at(t->out)[axis]) <= core[axis]) span.out = std::max(span.out, t->out);
    }
  }
  for (const T t : {span.in, span.out}) {
    const Vec3<T> p = search.at(t);
    Vec3<T> ng = p - glm::clamp(p, -core, core);
    if (r == 0) {  // the nearest face
      const Vec3<T> e = glm::abs(p) - half;
      const int axis = e.x >= e.y && e.x >= e.z ? 0 : e.y >= e.z ? 1 : 2;
      ng = Vec3<T>(0);
      ng[axis] = p[axis];
    }
    if (span.in <= span.out && search.offer(t, ng)) return;
  }
}

template <class T>
void cross(const Solid& solid, Search<T>& search) {
  const float4& parameters = solid.parameters;
  switch (solid.shape) {
    case SHAPE_SPHERE:
      return sphere(search);
    case SHAPE_PLANE:
      return plane(search);
    case SHAPE_BOX:
      return box(search);
    case SHAPE_CYLINDER:
      return cylinder(search, parameters);
    case SHAPE_CONE:
      return cone(search, parameters);
    case SHAPE_DISK:
      return ring<T>(search, 0, parameters.x, 1, 1);
    case SHAPE_RECTANGLE:
      return rectangle(search);
    case SHAPE_TORUS:
      return torus(search, parameters);
    case SHAPE_ROUNDBOX:
      return round_box(search, parameters);
    case SHAPE_LATHE:
      return lathe(search, solid);
    default:  // solids without a function here; slow
      for (const SolidCrossing& crossing : crossings_by_distance(
               {static_cast<ShapeKind>(solid.shape), glm::dvec3(1), parameters}, search.o, search.d))
        search.offer(static_cast<T>(crossing.t), crossing.ng);
  }
}

}  // namespace

bool closest_in_solid(const Solid& solid, const Ray& ray, SolidHit& hit) {
  Search<float> search{ray.o, ray.d, ray.t_min, ray.t_max};
  cross(solid, search);
  hit = {search.t_max, search.ng};
  return search.found;
}

std::vector<SolidCrossing> solid_crossings(const Solid& solid, const glm::dvec3& o, const glm::dvec3& d) {
  std::vector<SolidCrossing> all;
  Search<double> search{.o = o, .d = d, .all = &all};
  cross(solid, search);
  std::ranges::sort(all, {}, &SolidCrossing::t);
  return all;
}

}  // namespace sundog::plain
