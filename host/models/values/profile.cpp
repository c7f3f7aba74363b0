// Evaluates Bezier cubics, and cuts them by blossoms at extrema and inflections of both coordinates.
#include "models/values/profile.h"

#include <algorithm>
#include <cmath>

namespace sundog {
namespace {

using glm::dvec2;

/// Coefficients of t, t^2 and t^3.
struct Powers {
  dvec2 one, two, three;
};
Powers powers_of(const ProfileCubic& p) {
  return {3.0 * (p.b - p.a), 3.0 * (p.a - 2.0 * p.b + p.c), p.d - p.a + 3.0 * (p.b - p.c)};
}

/// Real roots of c + b t + a t^2.
void add_roots(double a, double b, double c, std::vector<double>& to) {
  const double left = b * b - 4 * a * c;
  if (left < 0) return;
  const double q = -(b + std::copysign(std::sqrt(left), b)) / 2;
  if (a != 0) to.push_back(q / a);
  if (q != 0) to.push_back(c / q);
}

/// The cubic between two of its parameters (blossoms).
ProfileCubic part_of(const ProfileCubic& p, double from, double till) {
  const auto blossom = [&](double r, double s, double t) {
    const auto mix = [](const dvec2& x, const dvec2& y, double share) { return x + share * (y - x); };
    const dvec2 ab = mix(p.a, p.b, r), bc = mix(p.b, p.c, r), cd = mix(p.c, p.d, r);
    return mix(mix(ab, bc, s), mix(bc, cd, s), t);
  };
  return {blossom(from, from, from), blossom(from, from, till), blossom(from, till, till),
          blossom(till, till, till)};
}

}  // namespace

dvec2 ProfileCubic::at(double t) const {
  const double s = 1 - t;
  return s * s * s * a + 3 * s * s * t * b + 3 * s * t * t * c + t * t * t * d;
}

dvec2 ProfileCubic::slope(double t) const {
  const double s = 1 - t;
  return 3.0 * (s * s * (b - a) + 2 * s * t * (c - b) + t * t * (d - c));
}

dvec2 ProfileCubic::bend(double t) const {
  return 6.0 * ((1 - t) * (a - 2.0 * b + c) + t * (b - 2.0 * c + d));
}

std::vector<ProfileCubic> monotone_parts(const ProfileCubic& cubic) {
  constexpr double least = 1e-6;  // minimum length of a part
  const Powers p = powers_of(cubic);
  std::vector<double> cuts;
  for (const int axis : {0, 1}) {
    add_roots(3 * p.three[axis], 2 * p.two[axis], p.one[axis], cuts);
    if (p.three[axis] != 0) cuts.push_back(-p.two[axis] / (3 * p.three[axis]));
  }
  std::ranges::sort(cuts);
  std::vector<ProfileCubic> parts;
  double from = 0;
  for (const double cut : cuts) {
    if (!(cut > from + least && cut < 1 - least)) continue;
    parts.push_back(part_of(cubic, from, cut));
    from = cut;
  }
  parts.push_back(part_of(cubic, from, 1));
  parts.front().a = cubic.a;
  parts.back().d = cubic.d;
  for (std::size_t i = 1; i < parts.size(); ++i) parts[i].a = parts[i - 1].d;
  return parts;
}

}  // namespace sundog
