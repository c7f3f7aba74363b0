// What facets of two widths return: the gains that give back what each loses to the others, and albedos of
// interfaces between dielectrics.
#pragma once
#include "compile/layers/albedos.h"

namespace sundog {

/// What an interface reflects at a cosine: of the relative index, and with a film's weight the film's row.
struct Interface {
  double eta, film;
  AlbedoRow film_row;
};

double interface_reflects(double cosine, const Interface& interface);

/// By the turn about the normal: row i for directions whose part along the tangent has the square i /
/// (LAYER_TURNS - 1) of the whole.
using FacetGains = std::array<AlbedoRow, LAYER_TURNS>;

/// The gains of both directions are factors on a white lobe, which then returns all light (lobe_energy.h);
/// being one function for both, they leave it reciprocal.
FacetGains facet_gains(const FacetWidths& widths);

struct FacetAlbedo {
  AlbedoRow of_interface;  // the most that facets which reflect as the interface does return
  double scale;            // 1 over the most that white ones return, at most 1
};
FacetAlbedo facet_albedo(const FacetWidths& widths, const FacetGains& gains, const Interface& interface);

}  // namespace sundog
