// Reflectance of anisotropic microfacets: gains that restore the energy lost between facets, and albedos of
// dielectric interfaces.
#pragma once
#include "compile/layers/albedos.h"

namespace sundog {

/// Reflectance of an interface by cosine: its relative index, blended by weight with a film's row.
struct Interface {
  double eta, film;
  AlbedoRow film_row;
};

double interface_reflects(double cosine, const Interface& interface);

/// Gains by azimuth: row i holds directions whose squared component along the tangent is i / (LAYER_TURNS -
/// 1) of that in the surface's plane.
using FacetGains = std::array<AlbedoRow, LAYER_TURNS>;

/// Gains multiply a white lobe by one function of both directions, so that it reflects all light
/// (lobe_energy.h) and stays reciprocal.
FacetGains facet_gains(const FacetWidths& widths);

struct FacetAlbedo {
  AlbedoRow of_interface;  // maximum albedo of facets with the interface's reflectance
  double scale;            // 1 / maximum albedo of white facets, at most 1
};
FacetAlbedo facet_albedo(const FacetWidths& widths, const FacetGains& gains, const Interface& interface);

}  // namespace sundog
