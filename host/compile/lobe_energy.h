// How much light rough surfaces keep when each ray is reflected by one facet alone.
#pragma once
#include <span>
#include <vector>

namespace sundog {

/// Which tables follow the first one.
struct LobeTables {
  bool gains = false, glass = false;
};

/// LOBE_STEPS times LOBE_STEPS values for white GGX facets: row by the root of the distribution's width
/// alpha, column by the cosine between the normal and the viewer (shared/lobe_energy.h). By quadrature over
/// visible normals. With `gains` as many values more: factors g(alpha, cosine) such that the BSDF times g of
/// both its directions returns all light of a white surrounding. Being the same function for both directions
/// it stays reciprocal, which a division by the energy of one is not. They are found as Sinkhorn and Knopp
/// (1967) scale a symmetric matrix. With `glass` the table from LOBE_GLASS on for white dielectrics: by 1 - 1
/// / eta, side (the thinner medium's first), alpha and cosine the energy that facets reflect and transmit.
/// Factors for both directions would be of no use there: they share light between the sides as they please,
/// and reflections of rough glass get a twentieth of what is theirs. So light that meets further facets is a
/// lobe of its own (kernels/lib/shade/microfacets.cl): from GLASS_THROUGH on the part of it that enters the
/// thicker medium, from GLASS_LOST on the means over directions of what the first meeting loses.
std::vector<float> make_lobe_energy(LobeTables wanted);

/// All tables, computed when sundog was built: a tenth of a second of two processors less in each start.
std::span<const float> built_lobe_energy();

}  // namespace sundog
