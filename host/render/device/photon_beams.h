// Groups the beams of a photon map for the search in kernels/plain/pathtracer/gather_beams.cl.
#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "shared/photons.h"

namespace sundog {

/// Draws at most `most` of a map's beams in proportion to their light, divides them among the map's samples,
/// and sorts each sample's beams into the same number of groups (shared/photons.h). A beam is three rows.
/// `number`: the map's index, which seeds the draw. `radius`: of a beam.
std::vector<float4> group_beams(std::span<const float4> beams, std::size_t most, u32 number, double radius);

}  // namespace sundog
