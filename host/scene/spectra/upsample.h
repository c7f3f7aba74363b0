// Spectra for colours: three spectra of red, green and blue that together are white, of which every colour's
// is a sum.
#pragma once
#include <array>

#include "scene/spectra/cie.h"

namespace sundog {

/// At each wavelength of shared/spectra.h the parts of red, green and blue: above 0, of sum 1. A colour c has
/// the spectrum dot(c, parts), which under D65 is seen as c. They are exponentials of quadratic polynomials
/// over the sum of the three, as the sigmoids of Jakob and Hanika ("A Low-Dimensional Function Space for
/// Efficient Spectral Upsampling", 2019) are for one colour, and found as those are by Newton's method; but a
/// sum of the three, as Mallett and Yuksel have it ("Spectral Primary Decomposition for Rendering with sRGB
/// Reflectance", 2019): so the spectrum of a sum of colours is the sum of theirs, lights and surfaces
/// included, colours of textures need no fit each, and white is exactly 1.
using SpectralBasis = std::array<dvec3, SPECTRUM_ROWS>;
const SpectralBasis& spectral_basis();

/// What a spectrum, a factor on D65 and linear between its rows, is seen as.
dvec3 color_of(const std::array<double, SPECTRUM_ROWS>& spectrum);

}  // namespace sundog
