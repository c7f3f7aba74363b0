// Similarity of two pixels of a film.
#pragma once
#include "render/film/film.h"

namespace sundog {

/// The mean of a pixel's samples.
Color color_at(const Film& film, std::size_t pixel);

/// The distance of two colours, in the units of pixel_errors().
float contrast(const Color& a, const Color& b);

/// Whether two pixels show similar surfaces: equal object, material and albedo, and a cosine of at least
/// `least_cosine` between normals; or both none. The film must have these AOVs.
bool same_surface(const Film& film, std::size_t a, std::size_t b, float least_cosine);

}  // namespace sundog
