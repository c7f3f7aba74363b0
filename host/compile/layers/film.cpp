// Combines the amplitudes of both interfaces by Airy's formula at each row of the spectrum; a metal becomes a
// dielectric of its reflectance.
#include "compile/layers/film.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "scene/spectra/upsample.h"

namespace sundog {
namespace {

/// Reflected amplitudes of both polarisations at an interface from index n to index m.
struct Amplitudes {
  double s, p;
};

Amplitudes reflected(double n, double cos_n, double m, double cos_m) {
  return {(n * cos_n - m * cos_m) / (n * cos_n + m * cos_m),
          (m * cos_n - n * cos_m) / (m * cos_n + n * cos_m)};
}

double airy(double first, double second, double cos_phase) {
  const double both = first * second, square = first * first, other = second * second;
  return (square + other + 2 * both * cos_phase) / (1 + square * other + 2 * both * cos_phase);
}

/// The cosine behind an interface; negative for total reflection.
double cosine_behind(double n, double cosine, double m) {
  const double square = 1 - (1 - cosine * cosine) * (n / m) * (n / m);
  return square > 0 ? std::sqrt(square) : -1;
}

double index_of_metal(double reflectance) {
  const double root = std::sqrt(std::clamp(reflectance, 0.0, 0.9999));
  return (1 + root) / (1 - root);
}

}  // namespace

double film_reflectance(const ThinFilm& film, double cosine, double wavelength) {
  const double cos_film = cosine_behind(film.before, cosine, film.index);
  if (cos_film < 0) return 1;
  const double cos_behind = cosine_behind(film.before, cosine, film.behind);
  const Amplitudes above = reflected(film.before, cosine, film.index, cos_film);
  const Amplitudes below =
      cos_behind < 0 ? Amplitudes{1, 1} : reflected(film.index, cos_film, film.behind, cos_behind);
  const double phase = std::cos(4 * std::numbers::pi * film.index * film.thickness * cos_film / wavelength);
  return std::clamp((airy(above.s, below.s, phase) + airy(above.p, below.p, phase)) / 2, 0.0, 1.0);
}

glm::dvec3 film_color(const ThinFilm& film, double cosine, const glm::dvec3& metal) {
  const bool of_metal = metal != glm::dvec3(0);
  std::array<double, SPECTRUM_ROWS> spectrum;
  for (std::size_t i = 0; i < spectrum.size(); ++i) {
    ThinFilm at = film;
    if (of_metal) at.behind = film.before * index_of_metal(glm::dot(spectral_basis()[i], metal));
    spectrum[i] = film_reflectance(at, cosine, SPECTRUM_FIRST + double(i) * SPECTRUM_STEP);
  }
  return glm::clamp(color_of(spectrum), glm::dvec3(0), glm::dvec3(1));
}

}  // namespace sundog
