// Subsampling: every second pixel each way gets its samples. Between four that agree on object, material,
// normal and colour the others are interpolated, unless a ray through their own middle sees something else:
// so nothing that the camera sees can hide between them, however thin. What is smaller in shadows and
// reflections is followed: where a pixel differs from what its corners promised, its neighbours get samples.
#pragma once
#include <optional>

#include "render/film/growing_film.h"

namespace sundog {

struct SamplingPlan;

/// The pass after those that `film` holds; none when the rest has been interpolated. Counts film.step.
std::optional<Pass> next_subsampling_pass(GrowingFilm& film, const SamplingPlan& plan);

/// Gives the pixels that have no samples the mean of their corners, where those have some.
void interpolate_rest(GrowingFilm& film);

}  // namespace sundog
