// Fits exponents quadratic in wavelength by Newton's method, until the primaries' spectra reproduce the
// primaries.
#include "scene/spectra/upsample.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sundog {
namespace {

constexpr std::size_t unknowns = 6;
using Vector = std::array<double, unknowns>;
using Matrix = std::array<Vector, unknowns>;

/// The basis for the quadratic exponents of red and blue; green's exponent is 0.
SpectralBasis basis_of(const Vector& p) {
  SpectralBasis basis;
  for (std::size_t i = 0; i < basis.size(); ++i) {
    const double t = (static_cast<double>(i) - 40) / 40;
    const double red = p[0] + t * (p[1] + t * p[2]), blue = p[3] + t * (p[4] + t * p[5]);
    const double most = std::max({red, blue, 0.0});
    const dvec3 parts(std::exp(red - most), std::exp(-most), std::exp(blue - most));
    basis[i] = parts / (parts.x + parts.y + parts.z);
  }
  return basis;
}

/// The integral of the product of two piecewise linear functions.
template <class First, class Second>
dvec3 integrate(const First& first, const Second& second) {
  dvec3 sum(0);
  for (std::size_t i = 0; i + 1 < SPECTRUM_ROWS; ++i)
    sum += first[i] * (2.0 * second[i] + second[i + 1]) + first[i + 1] * (second[i] + 2.0 * second[i + 1]);
  return sum * (static_cast<double>(SPECTRUM_STEP) / 6);
}

/// The residual of the round trip for red and blue; green follows, because all three sum to white.
Vector miss_of(const Vector& p) {
  const SpectralBasis basis = basis_of(p);
  std::array<double, SPECTRUM_ROWS> red{}, blue{};
  for (std::size_t i = 0; i < basis.size(); ++i) red[i] = basis[i].x, blue[i] = basis[i].z;
  const dvec3 seen_red = color_of(red), seen_blue = color_of(blue);
  return {seen_red.x - 1, seen_red.y, seen_red.z, seen_blue.x, seen_blue.y, seen_blue.z - 1};
}

/// Solves m x = b by elimination with partial pivoting.
Vector solve(Matrix m, Vector b) {
  for (std::size_t k = 0; k < unknowns; ++k) {
    std::size_t best = k;
    for (std::size_t i = k + 1; i < unknowns; ++i)
      if (std::abs(m[i][k]) > std::abs(m[best][k])) best = i;
    std::swap(m[k], m[best]);
    std::swap(b[k], b[best]);
    for (std::size_t i = k + 1; i < unknowns; ++i) {
      const double factor = m[i][k] / m[k][k];
      for (std::size_t j = k; j < unknowns; ++j) m[i][j] -= factor * m[k][j];
      b[i] -= factor * b[k];
    }
  }
  for (std::size_t k = unknowns; k-- > 0;) {
    for (std::size_t j = k + 1; j < unknowns; ++j) b[k] -= m[k][j] * b[j];
    b[k] /= m[k][k];
  }
  return b;
}

Vector newton_step(const Vector& p) {
  constexpr double small = 1e-6;
  Matrix slopes{};
  const Vector miss = miss_of(p);
  for (std::size_t j = 0; j < unknowns; ++j) {
    Vector moved = p;
    moved[j] += small;
    const Vector there = miss_of(moved);
    for (std::size_t i = 0; i < unknowns; ++i) slopes[i][j] = (there[i] - miss[i]) / small;
  }
  return solve(slopes, miss);
}

/// Starts Newton's method from smooth steps near 590 and 490 nm, where it converges.
SpectralBasis fit_basis() {
  Vector p{-1.8, 27.9, 51.4, -3.5, 8.9, 35.7};
  for (int i = 0; i < 12; ++i) {
    const Vector step = newton_step(p);
    for (std::size_t j = 0; j < unknowns; ++j) p[j] -= step[j];
  }
  return basis_of(p);
}

}  // namespace

const SpectralBasis& spectral_basis() {
  static const SpectralBasis basis = fit_basis();
  return basis;
}

dvec3 color_of(const std::array<double, SPECTRUM_ROWS>& spectrum) {
  return integrate(rgb_weights(), spectrum);
}

}  // namespace sundog
