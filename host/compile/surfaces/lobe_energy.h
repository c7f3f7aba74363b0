// Energy tables of rough surfaces with single scattering.
#pragma once
#include <span>
#include <vector>

namespace sundog {

/// Tables that follow the first one.
struct LobeTables {
  bool gains = false, glass = false;
};

/// LOBE_STEPS times LOBE_STEPS albedos of white GGX facets: rows by the square root of alpha, columns by the
/// viewer's cosine (shared/lobe_energy.h), by quadrature over visible normals. With `gains`, as many factors
/// g(alpha, cosine): the BSDF times g of both directions reflects all light of a white surrounding. A
/// symmetric factor keeps it reciprocal, unlike division by one direction's energy; found by Sinkhorn and
/// Knopp's (1967) scaling of a symmetric matrix. With `glass`, the table from LOBE_GLASS on: reflected and
/// transmitted energy of white dielectrics by 1 - 1 / eta, side (thinner medium first), alpha and cosine.
/// Symmetric factors fail for these: they divide light arbitrarily between the sides, and rough glass would
/// reflect a twentieth of what it should. Instead, multiple scattering is a separate lobe
/// (kernels/plain/shade/lobes/ggx.cl): GLASS_THROUGH holds its share that enters the thicker medium,
/// GLASS_LOST the mean energy lost at the first facet.
std::vector<float> make_lobe_energy(LobeTables wanted);

/// All tables as computed when sundog was built, which saves a tenth of a second on two cores at each start.
std::span<const float> built_lobe_energy();

}  // namespace sundog
