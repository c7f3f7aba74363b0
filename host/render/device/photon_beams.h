// Beams of photons, in groups for the search of kernels/plain/pathtracer/gather_beams.cl.
#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "shared/photons.h"

namespace sundog {

/// The groups (shared/photons.h) of at most `most` of a map's beams, three rows each, drawn by their light:
/// as many groups for each sample of the map, of beams apart. `number`: the map's, which chooses; `radius`:
/// of a beam.
std::vector<float4> group_beams(std::span<const float4> beams, std::size_t most, u32 number, double radius);

}  // namespace sundog
