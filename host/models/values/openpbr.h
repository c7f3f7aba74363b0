// OpenPBR Surface 1.1 (Academy Software Foundation, 2024): a material's parameters by the specification's
// names and defaults, and their conversion to MaterialDescription.
#pragma once
#include <glm/glm.hpp>

namespace sundog {

/// From bottom to top: a base (a metal, or a dielectric over a diffuse ground or a medium), a thin film, a
/// coat, fuzz. Weights, colours and roughnesses are in [0, 1].
struct OpenPbr {
  // No texture can replace these:
  double base_weight = 1;
  double base_diffuse_roughness = 0;
  double specular_weight = 1;  // scales normal reflectance of a dielectric, and a metal's
  glm::dvec3 specular_color{1};
  double specular_roughness_anisotropy = 0;
  double specular_ior = 1.5;
  glm::dvec3 transmission_color{1};
  double transmission_depth = 0;               // depth at which that colour remains; 0: tints the surface
  glm::dvec3 transmission_scatter{0};          // over that depth, albedo of the lost light
  double transmission_scatter_anisotropy = 0;  // mean cosine
  double transmission_dispersion_scale = 0;
  double transmission_dispersion_abbe_number = 20;
  glm::dvec3 coat_color{1};
  double coat_roughness = 0;
  double coat_roughness_anisotropy = 0;
  double coat_ior = 1.6;
  double coat_darkening = 1;  // strength of darkening by inner reflections in the coat
  double fuzz_weight = 0;
  glm::dvec3 fuzz_color{1};
  double fuzz_roughness = 0.5;
  double thin_film_weight = 0;
  double thin_film_thickness = 0.5;  // micrometres
  double thin_film_ior = 1.4;
  double emission_luminance = 0;  // as radiance in the scene's units
  double geometry_tangent = 0;    // degrees from the first texture coordinate, counterclockwise from outside
  bool geometry_thin_walled = false;  // transmits through a wall of specular_ior, without inside
  // A texture can replace these, except coat_bends:
  glm::dvec3 base_color{0.8};
  double base_metalness = 0;
  double specular_roughness = 0.3;
  double transmission_weight = 0;
  double coat_weight = 0;
  bool coat_bends = true;  // refraction in the coat changes the base's apparent index and roughness
  glm::dvec3 emission_color{1};
  double geometry_opacity = 1;
};

/// GGX widths along and across the tangent.
struct FacetWidths {
  double x, y;
};
FacetWidths facet_widths(double roughness, double anisotropy);

struct MaterialDescription;
struct MediumDescription;

/// Converts `values` to the material's terms, and stores them as its layers:
///   diffuse       base_weight base_color, also the metal's colour; a tenth of it ambient where matte
///   reflection    transmission_weight (1 - base_metalness) specular_color, by Fresnel: a medium's interface
///   transmission  the same share of transmission_color, or of 1 if the medium has that colour at a depth
///   roughness, emission, opacity by their names
/// If a texture sets metalness, these are the terms of the non-metal part; if one sets transmission, the
/// transmitted terms assume full and the ambient term no transmission; kernels apply the textures. Returns
/// whether light enters the surface, and then sets `inside`: index, dispersion, and absorption and scattering
/// that leave transmission_color after transmission_depth. A thin wall has no inside and is tinted by
/// transmission_color once.
bool set_openpbr(const OpenPbr& values, MaterialDescription& material, MediumDescription& inside);

}  // namespace sundog
