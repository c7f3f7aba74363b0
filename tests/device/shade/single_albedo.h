// The albedo of white microfacets that light meets once, by quadrature in double precision: an independent
// reference for both integrators.
#pragma once
#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <numbers>

namespace sundog {

struct OnceLight {
  double reflected = 0, transmitted = 0;
};

/// Smith's measure of masking and shadowing (Walter and others 2007, equation 34, as Lambda).
inline double smith_of(double cosine, double alpha) {
  const double square = cosine * cosine;
  return (std::sqrt(1 + alpha * alpha * (1 - square) / square) - 1) / 2;
}

/// Fresnel's reflectance without polarisation; `eta` is the index behind over the one before.
inline double fresnel_of(double cosine, double eta) {
  const double square = 1 - (1 - cosine * cosine) / (eta * eta);
  if (square <= 0) return 1;
  const double bent = std::sqrt(square);
  const double s = (cosine - eta * bent) / (cosine + eta * bent);
  const double p = (eta * cosine - bent) / (eta * cosine + bent);
  return (s * s + p * p) / 2;
}

/// The shares of light at `cosine` to the normal; `eta` 0: facets are perfect mirrors. Normals of facets are
/// taken by the GGX distribution (Walter and others 2007, equations 35 and 36) with 1 - q^2 as its first
/// number, which leaves nothing unbounded at flat angles.
inline OnceLight light_met_once(double cosine, double alpha, double eta) {
  constexpr int steps = 400;
  const glm::dvec3 o(std::sqrt(1 - cosine * cosine), 0, cosine);
  OnceLight sum;
  for (int i = 0; i < steps * steps; ++i) {
    const double q = (i / steps + 0.5) / steps, turn = 2 * std::numbers::pi * (i % steps + 0.5) / steps;
    const double c = q / std::hypot(q, alpha * std::sqrt(1 - q * q)), s = std::sqrt(1 - c * c);
    const glm::dvec3 h(s * std::cos(turn), s * std::sin(turn), c);
    const double seen = glm::dot(o, h);
    if (seen <= 0) continue;
    const double share = 2 * q * seen / (c * cosine * steps * steps), f = eta > 0 ? fresnel_of(seen, eta) : 1;
    const auto leaves = [&](double z) {
      return z > 0 ? share / (1 + smith_of(cosine, alpha) + smith_of(z, alpha)) : 0;
    };
    sum.reflected += f * leaves((2 * seen * h - o).z);
    if (f < 1) sum.transmitted += (1 - f) * leaves(-glm::refract(-o, h, 1 / eta).z);
  }
  return sum;
}

}  // namespace sundog
