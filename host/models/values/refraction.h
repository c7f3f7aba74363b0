// Dispersion: the refractive index by wavelength, and a catalogue of substances.
#pragma once
#include <array>
#include <optional>
#include <span>
#include <string_view>

namespace sundog {

/// Fraunhofer's lines in nm: blue, yellow, red.
inline constexpr double line_F = 486.1327, line_d = 587.5618, line_C = 656.2725;

enum class DispersionKind { none, cauchy, sellmeier };

/// n(wavelength), with l the wavelength in micrometres.
struct Dispersion {
  DispersionKind kind = DispersionKind::none;
  /// Cauchy: n = c0 + c1 / l^2 + c2 / l^4. Sellmeier: n^2 = 1 + sum of c[2i] l^2 / (l^2 - c[2i + 1]), up to
  /// four terms.
  std::array<double, 8> coefficients{};
  bool operator==(const Dispersion&) const = default;
};

/// The refractive index at a wavelength in nm; `ior` without dispersion. May be infinite or NaN at a pole or
/// negative square of Sellmeier's formula.
double index_at(const Dispersion& dispersion, double ior, double wavelength);

/// Two-term Cauchy from the index at the d line and the Abbe number (n_d - 1) / (n_F - n_C).
Dispersion cauchy_of_abbe(double index_d, double abbe);

/// A substance of the catalogue.
struct Substance {
  std::string_view name;
  Dispersion dispersion;
};

/// BK7, SF10, F2, fused_silica, water, ice, diamond; sources in refraction.cpp.
std::span<const Substance> substances();
std::optional<Dispersion> find_substance(std::string_view name);

}  // namespace sundog
