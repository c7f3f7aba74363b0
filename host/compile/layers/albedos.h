// Directional albedos of single lobes, by quadrature in double precision.
#pragma once
#include <array>

#include "scene/materials/openpbr.h"
#include "shared/layers.h"

namespace sundog {

/// By the cosine to the normal, from 0 to 1.
using AlbedoRow = std::array<double, LAYER_STEPS>;

/// The cosine of a column, a little above 0 in the first.
double layer_cosine(std::size_t column);
/// A row between its columns.
double at_cosine(const AlbedoRow& row, double cosine);
/// A direction at the cosine to z, turned about it.
glm::dvec3 viewer(double cosine, double turn);

inline constexpr double least_fuzz_alpha = 0.01;
AlbedoRow fuzz_albedo(double alpha);

/// The most that a white matte ground returns of light that arrives by `past`.
double matte_albedo(double roughness, const AlbedoRow& past);

}  // namespace sundog
