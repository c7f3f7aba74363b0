// The eye and daylight: CIE 1931 colour matching functions of 2 degrees and the illuminant D65 (CIE
// 15:2004), and what wavelengths add to linear sRGB.
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

/// At the wavelengths of shared/spectra.h.
std::span<const CieRow, SPECTRUM_ROWS> cie_rows();

/// What D65 of unit luminance adds to linear RGB per nm at each of these wavelengths: between them linear,
/// and integrated from the first to the last exactly (1, 1, 1). Spectra of colours are factors on D65, so
/// that white is 1 at every wavelength. Pure wavelengths lie outside of sRGB: some weights are below 0.
using RgbWeights = std::array<dvec3, SPECTRUM_ROWS>;
const RgbWeights& rgb_weights();

/// The same at any wavelength in nm; 0 outside of the table.
dvec3 rgb_weight(double wavelength);

/// Linear RGB of a black body of that temperature in kelvin (Planck's law), of the luminance 1; what lies
/// outside of sRGB is 0.
dvec3 black_body_color(double kelvin);

}  // namespace sundog
