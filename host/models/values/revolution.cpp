// Cuts the profile into monotone parts; distances by Newton's method from the nearest of eight chords,
// lengths by Gauss' rule, reach by bisection.
#include "models/values/revolution.h"

#include <algorithm>
#include <cmath>

namespace sundog {
namespace {

float4 row(double x, double y, double z, double w) {
  return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z), static_cast<float>(w)};
}

/// The length by Gauss' rule of five points, on four pieces.
double length_of(const ProfileCubic& p) {
  constexpr double places[] = {-0.9061798459386640, -0.5384693101056831, 0, 0.5384693101056831,
                               0.9061798459386640},
                   weights[] = {0.2369268850561891, 0.4786286704993665, 0.5688888888888889,
                                0.4786286704993665, 0.2369268850561891};
  double sum = 0;
  for (int piece = 0; piece < 4; ++piece)
    for (int i = 0; i < 5; ++i)
      sum += weights[i] / 8 * glm::length(p.slope((piece + 0.5 + places[i] / 2) / 4));
  return sum;
}

ProfileArc arc_of(const ProfileCubic& p) {
  const dvec2 one = 3.0 * (p.b - p.a), size = p.d - p.a;
  dvec2 two = 3.0 * (p.a - 2.0 * p.b + p.c), three = size + 3.0 * (p.b - p.c);
  for (dvec2* bend : {&two, &three})  // keep lines straight in spite of rounding
    if (glm::length(*bend) < 1e-12 * glm::length(one)) *bend = dvec2(0);
  return {row(p.a.x, one.x, two.x, three.x), row(p.a.y, one.y, two.y, three.y), row(p.d.x, p.d.y, 0, 0), {}};
}

double box_distance(const ProfileCubic& p, const dvec2& q) {
  const dvec2 low = glm::min(p.a, p.d), high = glm::max(p.a, p.d);
  return glm::length(glm::max(glm::max(low - q, q - high), dvec2(0)));
}

double greatest_curvature(const ProfileCubic& part) {
  constexpr int places = 32;
  double most = 0;
  for (int i = 0; i <= places; ++i) {
    const double t = double(i) / places;
    const dvec2 p = part.at(t), slope = part.slope(t), bend = part.bend(t);
    const double size = glm::length(slope);
    if (!(size > 1e-9 * glm::length(part.d - part.a))) continue;
    most = std::max(most, std::abs(slope.x * bend.y - slope.y * bend.x) / (size * size * size));
    const double lean = std::abs(slope.y) / size;
    if (lean > 1e-6) most = std::max(most, p.x > 0 ? lean / p.x : INFINITY);
  }
  return most;
}

/// The distance of q from a part, by Newton's method from the nearest of eight chords.
double distance_from(const ProfileCubic& p, const dvec2& q) {
  constexpr int chords = 8;
  double best = 0, least = INFINITY;
  dvec2 a = p.a;
  for (int i = 0; i < chords; ++i) {
    const dvec2 b = i + 1 < chords ? p.at(double(i + 1) / chords) : p.d, along = b - a;
    const double square = glm::dot(along, along);
    const double share = square > 0 ? std::clamp(glm::dot(q - a, along) / square, 0.0, 1.0) : 0;
    const double distance = glm::length(q - a - share * along);
    if (distance < least) least = distance, best = (i + share) / chords;
    a = b;
  }
  for (int i = 0; i < 6; ++i) {
    const dvec2 off = p.at(best) - q, slope = p.slope(best);
    const double rise = glm::dot(slope, slope) + glm::dot(off, p.bend(best));
    if (!(rise > 0)) break;
    best = std::clamp(best - glm::dot(off, slope) / rise, 0.0, 1.0);
  }
  return std::min({glm::length(p.at(best) - q), glm::length(p.a - q), glm::length(p.d - q)});
}

/// Whether a ray from q away from the axis crosses a part.
bool is_beside(const ProfileCubic& p, const dvec2& q) {
  if ((p.a.y <= q.y) == (p.d.y <= q.y)) return false;
  if (std::max(p.a.x, p.d.x) <= q.x) return false;
  if (std::min(p.a.x, p.d.x) > q.x) return true;
  double low = 0, high = 1;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    ((p.at(middle).y <= q.y) == (p.a.y <= q.y) ? low : high) = middle;
  }
  return p.at(low).x > q.x;
}

}  // namespace

Revolution::Revolution(const std::vector<ProfileCubic>& profile, bool closed, double scale)
    : closed_(closed) {
  for (ProfileCubic cubic : profile) {
    for (dvec2* point : {&cubic.a, &cubic.b, &cubic.c, &cubic.d}) *point /= scale;
    for (const ProfileCubic& part : monotone_parts(cubic)) parts_.push_back(part);
  }
  double whole = 0;
  for (const ProfileCubic& part : parts_) {
    arcs_.push_back(arc_of(part));
    curvatures_.push_back(sundog::greatest_curvature(part));
    const double length = length_of(part);
    arcs_.back().along = row(whole, length, 0, 0);
    whole += length;
  }
  for (ProfileArc& arc : arcs_) arc.along.z = static_cast<float>(whole);
}

double Revolution::reach(double across, double along) const {
  double most = -INFINITY;
  const auto offer = [&](const dvec2& p) { most = std::max(most, p.x * across + p.y * along); };
  for (const ProfileCubic& part : parts_) {
    offer(part.a);
    offer(part.d);
    // The maximum lies where the slope along the direction changes from rising to falling.
    constexpr int pieces = 16;
    const auto slope = [&](double t) { return part.slope(t).x * across + part.slope(t).y * along; };
    for (int i = 0; i < pieces; ++i) {
      double low = double(i) / pieces, high = double(i + 1) / pieces;
      if (!(slope(low) > 0 && slope(high) < 0)) continue;
      for (int k = 0; k < 50; ++k) (slope((low + high) / 2) > 0 ? low : high) = (low + high) / 2;
      offer(part.at(low));
    }
  }
  return most;
}

double Revolution::distance(const dvec3& q) const {
  const dvec2 place(std::hypot(q.x, q.z), q.y);
  double least = INFINITY;
  bool inside = false;
  for (const ProfileCubic& part : parts_) {
    if (box_distance(part, place) < least) least = std::min(least, distance_from(part, place));
    inside ^= is_beside(part, place);
  }
  return closed_ && inside ? -least : least;
}

double Revolution::greatest_curvature(const dvec3& near, double within) const {
  const dvec2 place(std::hypot(near.x, near.z), near.y);
  double most = 0;
  for (std::size_t i = 0; i < parts_.size(); ++i)
    if (curvatures_[i] > most && !(box_distance(parts_[i], place) > within)) most = curvatures_[i];
  return most;
}

std::vector<dvec2> Revolution::rings() const {
  std::vector<dvec2> found;
  for (const ProfileCubic& part : parts_)
    if (part.a.y == part.d.y && part.b.y == part.a.y && part.c.y == part.a.y)
      found.emplace_back(std::max(part.a.x, part.d.x), part.a.y);
  return found;
}

}  // namespace sundog
