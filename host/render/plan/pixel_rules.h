// Compares two pixels of a film: the contrast of their colours, and whether they show similar surfaces.
#pragma once
#include "render/film/film.h"

namespace sundog {

/// The mean of a pixel's samples.
Color color_at(const Film& film, std::size_t pixel);

/// The distance of two colours, in the units of pixel_errors().
float contrast(const Color& a, const Color& b);

/// Whether two pixels show similar surfaces: equal object and material, nearly equal albedo, and a cosine of
/// at least `least_cosine` between normals; or both show none. The film must have these AOVs.
bool same_surface(const Film& film, std::size_t a, std::size_t b, float least_cosine);

}  // namespace sundog
