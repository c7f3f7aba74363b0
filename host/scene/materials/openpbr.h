// OpenPBR Surface 1.1 (Academy Software Foundation, 2024): a material's values by the specification's names,
// with its defaults, and what they are in the terms of MaterialDescription.
#pragma once
#include <glm/glm.hpp>

namespace sundog {

/// From below: a base, which is a metal or a dielectric over a matte ground or over a medium; a film of
/// light's own thickness on it; a coat; fuzz. Weights, colours and roughnesses are in [0, 1].
struct OpenPbr {
  double base_weight = 1;
  glm::dvec3 base_color{0.8};
  double base_metalness = 0;
  double base_diffuse_roughness = 0;
  double specular_weight = 1;  // [0, 10]: on a dielectric's reflectance straight on, and on a metal's
  glm::dvec3 specular_color{1};
  double specular_roughness = 0.3;
  double specular_roughness_anisotropy = 0;
  double specular_ior = 1.5;
  double transmission_weight = 0;
  glm::dvec3 transmission_color{1};
  double transmission_depth = 0;               // where that colour is left; 0: it is that of the surface
  glm::dvec3 transmission_scatter{0};          // over that depth, of the light that does not get through
  double transmission_scatter_anisotropy = 0;  // [-0.99, 0.99]: mean cosine of its turns
  double transmission_dispersion_scale = 0;
  double transmission_dispersion_abbe_number = 20;
  double coat_weight = 0;
  glm::dvec3 coat_color{1};
  double coat_roughness = 0;
  double coat_roughness_anisotropy = 0;
  double coat_ior = 1.6;
  bool coat_bends = true;  // light below it: the base's index and roughness are those seen through the coat
  double coat_darkening = 1;  // how much of what inner reflections of the coat take from the base
  double fuzz_weight = 0;
  glm::dvec3 fuzz_color{1};
  double fuzz_roughness = 0.5;
  double thin_film_weight = 0;
  double thin_film_thickness = 0.5;  // micrometres
  double thin_film_ior = 1.4;
  double emission_luminance = 0;  // radiance, in the scene's units
  glm::dvec3 emission_color{1};
  double geometry_opacity = 1;
  double geometry_tangent = 0;  // degrees from the surface's first coordinate, against the clock from outside
  bool geometry_thin_walled = false;  // what transmits is a thin wall of specular_ior, without an inside
};

/// Widths of the GGX distribution along and across the tangent.
struct FacetWidths {
  double x, y;
};
FacetWidths facet_widths(double roughness, double anisotropy);

struct MaterialDescription;
struct MediumDescription;

/// The values as terms of the material, which keeps `values` as its layers:
///   diffuse       base_weight base_color, which is the metal's colour too; a tenth of it ambient where matte
///   reflection    transmission_weight (1 - base_metalness) specular_color, by Fresnel: what lies over a
///   medium transmission  the same share of transmission_color, or of 1 where that is the medium's at a depth
///   roughness, emission, opacity by their names
/// Where a texture of the material gives its metalness, these are the terms of what is no metal, and where
/// one gives its transmission those of rays are of all that may transmit and the ambient one of what does
/// not: kernels take the rest from them. Returns whether light goes into the surface, and sets `inside` then:
/// index and dispersion, and absorption and scattering that leave transmission_color after
/// transmission_depth. A thin wall has no inside, and is tinted by transmission_color once.
bool set_openpbr(const OpenPbr& values, MaterialDescription& material, MediumDescription& inside);

}  // namespace sundog
