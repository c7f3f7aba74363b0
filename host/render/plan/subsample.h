// Subsampling: renders every second pixel each way. Between four pixels that agree on object, material,
// normal and colour, the others are interpolated, unless a ray through their centre sees a different surface;
// so nothing that the camera sees is missed, however thin. Small features in shadows and reflections are
// traced: where a pixel differs from its corners' interpolation, its neighbours are sampled.
#pragma once
#include <optional>

#include "render/film/pass.h"

namespace sundog {

struct SamplingPlan;

/// The pass after those in `film`; none when the rest has been interpolated. Increments film.step.
std::optional<Pass> next_subsampling_pass(Film& film, const SamplingPlan& plan);

/// Sets pixels without samples to the mean of those corners that have some.
void interpolate_rest(Film& film);

}  // namespace sundog
