// Directional albedos of single lobes by quadrature, in double precision.
#pragma once
#include <array>

#include "models/values/openpbr.h"
#include "shared/layers.h"

namespace sundog {

/// Values by the cosine to the normal, from 0 to 1.
using AlbedoRow = std::array<double, LAYER_STEPS>;

/// The cosine of a column; slightly above 0 for the first.
double layer_cosine(std::size_t column);
/// Interpolates a row between columns.
double at_cosine(const AlbedoRow& row, double cosine);
/// A direction with this cosine to z and azimuth.
glm::dvec3 viewer(double cosine, double turn);

inline constexpr double least_fuzz_alpha = 0.01;
AlbedoRow fuzz_albedo(double alpha);

/// Maximum albedo of a white matte ground for light that arrives through `past`.
double matte_albedo(double roughness, const AlbedoRow& past);

}  // namespace sundog
