// Which pixels get which samples next: arithmetic over a growing film, the same whoever makes the samples.
#pragma once
#include <optional>

#include "render/film/growing_film.h"
#include "scene/description.h"

namespace sundog {

/// What a frame is sampled by.
struct SamplingPlan {
  Sampling settings;
  u32 samples = 1;        // a pixel, at most
  double noise = 0;       // the frame ends when its mean error is below; 0: never
  bool surfaces = false;  // AOVs are wanted of every pixel
};

/// Whether a frame is made in passes.
bool in_passes(const Sampling& settings);

/// Whether the passes ask for what the camera sees first.
bool needs_surfaces(const Sampling& settings);

/// The pass after those that `film` holds, of which `last` is the last if there are any; none when the frame
/// is finished. Counts film.step. Its pixels are those of a whole image or of a list.
std::optional<Pass> next_pass(GrowingFilm& film, const SamplingPlan& plan, const Pass& last = {});

/// Whether the plan may make a pass of those samples: one that is read from a file has to be asked.
bool may_be_of(const SamplingPlan& plan, const Pass& pass);

/// The mean of the pixels' estimated errors (pixel_errors()); infinite while nothing is known.
double mean_error(const GrowingFilm& film);

}  // namespace sundog
