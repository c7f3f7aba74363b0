// How much light rough surfaces keep when each ray is reflected by one facet alone.
#pragma once
#include <vector>

namespace sundog {

/// LOBE_STEPS times LOBE_STEPS values for white GGX facets: row by the distribution's width alpha, column by
/// the cosine between the normal and the viewer, both from 0 to 1. By quadrature over visible normals.
std::vector<float> make_lobe_energy();

}  // namespace sundog
