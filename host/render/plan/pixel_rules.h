// When two pixels of a film look alike.
#pragma once
#include "render/film/film.h"

namespace sundog {

/// The mean of a pixel's samples.
Color color_at(const Film& film, std::size_t pixel);

/// How far two colours are apart, as pixel_errors() measures it.
float contrast(const Color& a, const Color& b);

/// Whether two pixels show surfaces alike: the same object and material, albedo, and normals less than
/// `least_cosine` apart; or both none. The film has AOVs of both.
bool same_surface(const Film& film, std::size_t a, std::size_t b, float least_cosine);

}  // namespace sundog
