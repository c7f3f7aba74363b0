// See solids.h. Each solid offers its crossings; the nearest one in the ray's range stays.
#include "bench/plain/solids.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "bench/plain/any_solid.h"

namespace sundog::plain {
namespace {

using glm::vec3;

struct Interval {
  float in = 0, out = 0;
};

struct Search {
  Ray ray;  // t_max shrinks to the nearest hit
  SolidHit hit;
  bool found = false;

  bool offer(float t, const vec3& ng) {
    if (!(t > ray.t_min && t <= ray.t_max)) return false;
    ray.t_max = t;
    hit = {t, ng};
    return found = true;
  }
  vec3 at(float t) const { return ray.o + t * ray.d; }
};

/// Where the line is within `radius` of the origin, in the space of the given vectors.
std::optional<Interval> round_interval(const vec3& o, const vec3& d, float radius) {
  const float a = glm::dot(d, d);
  if (!(a > 0)) return {};
  const float b = -glm::dot(o, d);
  const vec3 nearest = o + (b / a) * d;
  const float left = radius * radius - glm::dot(nearest, nearest);
  if (left < 0) return {};
  const float q = b + std::copysign(std::sqrt(a * left), b);
  const float t0 = q != 0 ? (glm::dot(o, o) - radius * radius) / q : 0, t1 = q / a;
  return Interval{std::min(t0, t1), std::max(t0, t1)};
}

struct BoxCrossing {
  Interval t{-std::numeric_limits<float>::infinity(), std::numeric_limits<float>::infinity()};
  int axis_in = 0, axis_out = 0;
};

std::optional<BoxCrossing> box_crossing(const vec3& o, const vec3& d, const vec3& half) {
  BoxCrossing box;
  for (int i = 0; i < 3; ++i) {
    if (d[i] == 0) {
      if (std::abs(o[i]) > half[i]) return {};
      continue;
    }
    const float side = std::copysign(half[i], d[i]);
    const float in = (-side - o[i]) / d[i], out = (side - o[i]) / d[i];
    if (in > box.t.in) box.t.in = in, box.axis_in = i;
    if (out < box.t.out) box.t.out = out, box.axis_out = i;
  }
  if (box.t.in > box.t.out) return {};
  return box;
}

void sphere(Search& search) {
  const auto t = round_interval(search.ray.o, search.ray.d, 1);
  if (t && !search.offer(t->in, search.at(t->in))) search.offer(t->out, search.at(t->out));
}

void plane(Search& search) {
  if (search.ray.d.y != 0) search.offer(-search.ray.o.y / search.ray.d.y, {0, 1, 0});
}

void box(Search& search) {
  const auto crossing = box_crossing(search.ray.o, search.ray.d, vec3(1));
  if (!crossing) return;
  vec3 in(0), out(0);
  in[crossing->axis_in] = -std::copysign(1.0f, search.ray.d[crossing->axis_in]);
  out[crossing->axis_out] = std::copysign(1.0f, search.ray.d[crossing->axis_out]);
  if (!search.offer(crossing->t.in, in)) search.offer(crossing->t.out, out);
}

/// inner <= radius <= outer in the plane y = height, normal towards `side` of y.
void ring(Search& search, float height, float inner, float outer, float side) {
  if (search.ray.d.y == 0) return;
  const float t = (height - search.ray.o.y) / search.ray.d.y;
  const vec3 p = search.at(t);
  const float r2 = p.x * p.x + p.z * p.z;
  if (r2 <= outer * outer && r2 >= inner * inner) search.offer(t, {0, side, 0});
}

void rectangle(Search& search) {
  if (search.ray.d.y == 0) return;
  const float t = -search.ray.o.y / search.ray.d.y;
  const vec3 p = search.at(t);
  if (std::max(std::abs(p.x), std::abs(p.z)) <= 1) search.offer(t, {0, 1, 0});
}

void cylinder(Search& search, const float4& parameters) {
  const vec3 flat(1, 0, 1);
  if (const auto t = round_interval(search.ray.o * flat, search.ray.d * flat, 1))
    for (const float root : {t->in, t->out})
      if (const vec3 p = search.at(root); std::abs(p.y) <= 1) search.offer(root, p * flat);
  if (parameters.x == 0) return;
  ring(search, 1, 0, 1, 1);
  ring(search, -1, 0, 1, -1);
}

/// The side: x^2 + z^2 = (m + k y)^2, |y| <= 1.
void cone(Search& search, const float4& parameters) {
  const float m = 0.5f * (parameters.x + parameters.y), k = 0.5f * (parameters.y - parameters.x);
  const vec3& d = search.ray.d;
  const float shift = -glm::dot(search.ray.o, d) / glm::dot(d, d);
  const vec3 s = search.at(shift);
  const float ro = m + k * s.y, rd = k * d.y;
  const float a = d.x * d.x + d.z * d.z - rd * rd, b = s.x * d.x + s.z * d.z - ro * rd,
              c = s.x * s.x + s.z * s.z - ro * ro;
  if (const float discriminant = b * b - a * c; discriminant >= 0) {
    const float q = -(b + std::copysign(std::sqrt(discriminant), b));
    const float t0 = q != 0 ? c / q : 0;
    for (const float t : {t0, a != 0 ? q / a : t0}) {
      const vec3 p = s + t * d;
      const float r = m + k * p.y;
      if (std::abs(p.y) <= 1 && r >= 0) search.offer(t + shift, {p.x, -k * r, p.z});
    }
  }
  if (parameters.z == 0) return;
  ring(search, 1, 0, parameters.y, 1);
  ring(search, -1, 0, parameters.x, -1);
}

using Polynomial = std::array<float, 5>;  // lowest power first

float value(const Polynomial& c, float x) { return (((c[4] * x + c[3]) * x + c[2]) * x + c[1]) * x + c[0]; }

/// Roots in [low, high], ascending: a polynomial is monotone between the roots of its derivative.
int roots_within(const Polynomial& c, int degree, float low, float high, std::array<float, 5>& roots) {
  if (degree == 0) return 0;
  Polynomial derivative{};
  for (std::size_t i = 1; i < 5; ++i) derivative[i - 1] = static_cast<float>(i) * c[i];
  std::array<float, 5> turns{};
  const int turn_count = roots_within(derivative, degree - 1, low, high, turns);
  int found = 0;
  float a = low;
  for (int i = 0; i <= turn_count; ++i) {
    const float b = i < turn_count ? turns[static_cast<std::size_t>(i)] : high;
    float left = a, right = b;
    a = b;
    if ((value(c, left) < 0) == (value(c, right) < 0)) continue;
    const bool rising = value(c, right) > value(c, left);
    float x = 0.5f * (left + right);
    for (int step = 0; step < 40; ++step) {
      const float f = value(c, x), slope = value(derivative, x);
      ((f > 0) == rising ? right : left) = x;
      const float newton = slope != 0 ? x - f / slope : left;
      const float next = newton > left && newton < right ? newton : 0.5f * (left + right);
      if (next == x) break;
      x = next;
    }
    roots[static_cast<std::size_t>(found++)] = x;
  }
  return found;
}

/// (|p|^2 + 1 - r^2)^2 = 4 (x^2 + z^2).
void torus(Search& search, const float4& parameters) {
  const float r = parameters.x, length = glm::length(search.ray.d);
  const vec3 e = search.ray.d / length;
  const float shift = -glm::dot(search.ray.o, e);
  const vec3 s = search.ray.o + shift * e;
  const float reach2 = (1 + r) * (1 + r) - glm::dot(s, s);
  if (!(reach2 > 0)) return;
  const float g = glm::dot(s, s) + 1 - r * r, reach = std::sqrt(reach2);
  const Polynomial quartic{g * g - 4 * (s.x * s.x + s.z * s.z), -8 * (s.x * e.x + s.z * e.z),
                           2 * g - 4 * (e.x * e.x + e.z * e.z), 0, 1};
  std::array<float, 5> roots{};
  const int count = roots_within(quartic, 4, -reach, reach, roots);
  for (int i = 0; i < count; ++i) {
    const float x = roots[static_cast<std::size_t>(i)];
    const vec3 p = s + x * e;
    const float inward = 1 - 1 / std::max(std::sqrt(p.x * p.x + p.z * p.z), 1e-12f);
    search.offer((x + shift) / length, {p.x * inward, p.y, p.z * inward});
  }
}

/// Widens `span` by the entry and exit of one of the solids whose union is the rounded box.
void widen(Interval& span, const Interval& t) { span = {std::min(span.in, t.in), std::max(span.out, t.out)}; }

/// Three boxes, twelve cylinders along the edges and eight spheres at the corners; their union is convex.
void round_box(Search& search, const float4& parameters) {
  const vec3 half(parameters.x, parameters.y, parameters.z);
  const float r = parameters.w;
  const vec3 core = half - r, &o = search.ray.o, &d = search.ray.d;
  if (!box_crossing(o, d, half)) return;
  Interval span{std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity()};
  for (int axis = 0; axis < 3; ++axis) {
    vec3 slab = core;
    slab[axis] = half[axis];
    if (const auto crossing = box_crossing(o, d, slab)) widen(span, crossing->t);
  }
  for (int corner = 0; corner < 8; ++corner) {
    const vec3 c = o - core * vec3(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
    if (const auto t = round_interval(c, d, r)) widen(span, *t);
    for (int axis = 0; axis < 3; ++axis) {
      if (corner >> axis & 1) continue;  // each edge once
      vec3 keep(1);
      keep[axis] = 0;
      const auto t = round_interval(c * keep, d * keep, r);
      if (t && std::abs(search.at(t->in)[axis]) <= core[axis]) span.in = std::min(span.in, t->in);
      if (t && std::abs(search.at(t->out)[axis]) <= core[axis]) span.out = std::max(span.out, t->out);
    }
  }
  for (const float t : {span.in, span.out}) {
    const vec3 p = search.at(t);
    if (span.in <= span.out && search.offer(t, p - glm::clamp(p, -core, core))) return;
  }
}

/// Slow: for solids that have no function here.
void by_distance(Search& search, const UnitShape& unit) {
  for (const SolidCrossing& crossing : crossings_by_distance(unit, search.ray.o, search.ray.d))
    search.offer(static_cast<float>(crossing.t), crossing.ng);
}

}  // namespace

bool closest_in_solid(u32 shape, const float4& parameters, const Ray& ray, SolidHit& hit) {
  Search search{ray, {}, false};
  switch (shape) {
    case SHAPE_SPHERE:
      sphere(search);
      break;
    case SHAPE_PLANE:
      plane(search);
      break;
    case SHAPE_BOX:
      box(search);
      break;
    case SHAPE_CYLINDER:
      cylinder(search, parameters);
      break;
    case SHAPE_CONE:
      cone(search, parameters);
      break;
    case SHAPE_DISK:
      ring(search, 0, parameters.x, 1, 1);
      break;
    case SHAPE_RECTANGLE:
      rectangle(search);
      break;
    case SHAPE_TORUS:
      torus(search, parameters);
      break;
    case SHAPE_ROUNDBOX:
      round_box(search, parameters);
      break;
    default:
      by_distance(search, {static_cast<ShapeKind>(shape), glm::dvec3(1), parameters});
  }
  hit = search.hit;
  return search.found;
}

}  // namespace sundog::plain
