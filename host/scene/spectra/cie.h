// CIE 1931 2-degree colour matching functions and illuminant D65 (CIE 15:2004), and the contribution of
// wavelengths to linear sRGB.
#pragma once
#include <array>
#include <glm/glm.hpp>
#include <span>

#include "shared/spectra.h"

namespace sundog {

using glm::dvec3;

struct CieRow {
  double x, y, z;
  double d65;  // relative power; 100 at 560 nm
};

/// The table's rows, at the wavelengths of shared/spectra.h.
std::span<const CieRow, SPECTRUM_ROWS> cie_rows();

/// Linear RGB per nm that D65 of unit luminance contributes at each of these wavelengths; linear in between,
/// and integrating to exactly (1, 1, 1). Colour spectra are factors on D65, so white is 1 at every
/// wavelength. Pure wavelengths lie outside sRGB, hence some negative weights.
using RgbWeights = std::array<dvec3, SPECTRUM_ROWS>;
const RgbWeights& rgb_weights();

/// The weights at any wavelength in nm; 0 outside the table.
dvec3 rgb_weight(double wavelength);

/// Linear RGB of a black body of this temperature in kelvin (Planck's law), with luminance 1; components
/// outside sRGB are clamped to 0.
dvec3 black_body_color(double kelvin);

}  // namespace sundog
