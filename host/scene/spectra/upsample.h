// Spectral upsampling: every colour's spectrum is a sum of three basis spectra that add up to white.
#pragma once
#include <array>

#include "scene/spectra/cie.h"

namespace sundog {

/// Weights of red, green and blue at each wavelength of shared/spectra.h: above 0, summing to 1. A colour c
/// has the spectrum dot(c, weights), which looks like c under D65. Each is an exponential of a quadratic
/// polynomial divided by the sum of the three, fitted by Newton's method like the sigmoids of Jakob and
/// Hanika ("A Low-Dimensional Function Space for Efficient Spectral Upsampling", 2019). As in Mallett and
/// Yuksel ("Spectral Primary Decomposition for Rendering with sRGB Reflectance", 2019), spectra are linear in
/// colour, so texture colours need no individual fit and white is exactly 1.
using SpectralBasis = std::array<dvec3, SPECTRUM_ROWS>;
const SpectralBasis& spectral_basis();

/// The colour of a spectrum given as factors on D65, linear between its rows.
dvec3 color_of(const std::array<double, SPECTRUM_ROWS>& spectrum);

}  // namespace sundog
