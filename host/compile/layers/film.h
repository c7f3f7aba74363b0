// Light that a film of about its own wavelength's thickness reflects.
#pragma once
#include <glm/glm.hpp>

namespace sundog {

/// A film between two media: their indices, before, in it and behind, and its thickness in nm.
struct ThinFilm {
  double before, index, behind, thickness;
};

/// The part of unpolarised light of the wavelength (nm) that is reflected at the cosine c: Airy's sum of all
/// reflections between the film's faces (Belcour and Barla 2017, "A Practical Extension to Microfacet Theory
/// for the Modeling of Varying Iridescence", equation 3), which they approximate and this evaluates.
double film_reflectance(const ThinFilm& film, double cosine, double wavelength);

/// The same as linear RGB under daylight, in [0, 1]: by all wavelengths. `behind` may differ by colour: above
/// a metal it is the index that reflects `metal` straight on, where that is not 0.
glm::dvec3 film_color(const ThinFilm& film, double cosine, const glm::dvec3& metal);

}  // namespace sundog
