// Reflectance of thin films (interference).
#pragma once
#include <glm/glm.hpp>

namespace sundog {

/// A film between two media: indices before, inside and behind it, and thickness in nm.
struct ThinFilm {
  double before, index, behind, thickness;
};

/// Reflectance for unpolarised light of a wavelength (nm) at the cosine c: Airy's sum over all reflections
/// between the film's faces, which Belcour and Barla 2017 ("A Practical Extension to Microfacet Theory for
/// the Modeling of Varying Iridescence", equation 3) approximate.
double film_reflectance(const ThinFilm& film, double cosine, double wavelength);

/// The reflectance over all wavelengths as linear RGB under daylight, in [0, 1]. `behind` may differ by
/// colour: above a metal it is the index with normal reflectance `metal`, unless that is 0.
glm::dvec3 film_color(const ThinFilm& film, double cosine, const glm::dvec3& metal);

}  // namespace sundog
