// Decides which pixels get which samples next, from the film so far; independent of who renders them.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "compile/compiled_scene.h"
#include "render/film/pass.h"
#include "scene/description.h"

namespace sundog {

/// Sampling parameters of a frame.
struct SamplingPlan {
  Sampling settings;
  u32 samples = 1;                       // maximum per pixel
  double noise = 0;                      // the frame ends when its mean error is below this; 0: never
  bool surfaces = false;                 // AOVs are needed for every pixel
  bool sums = false;                     // those AOVs include sums over all samples
  bool noisy = false;                    // errors are pooled_squares()
  std::vector<std::uint8_t> panes = {};  // per material; 1: partly clear, other surfaces are seen through it
};

/// The scene's plan for a frame without AOVs.
SamplingPlan plan_sampling(const CompiledScene& scene);

/// Whether a frame is rendered in several passes; a plain frame has one with all samples.
bool in_passes(const Sampling& settings);

/// Whether the passes need the surfaces that the camera sees.
bool needs_surfaces(const Sampling& settings);

/// The pass after those in `film`, of which `last` is the last, if any; none when the frame is finished.
/// Increments film.step. Covers the whole image or a list of pixels.
std::optional<Pass> next_pass(Film& film, const SamplingPlan& plan, const Pass& last = {});

/// Whether a pass can belong to the plan; validates passes read from files.
bool may_be_of(const SamplingPlan& plan, const Pass& pass);

/// The mean of the pixels' estimated errors (pixel_errors()); infinite while unknown.
double mean_error(const Film& film);

}  // namespace sundog
