// See passes.h.
#include "render/plan/passes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "render/plan/convergence.h"
#include "render/plan/pixel_rules.h"
#include "render/plan/subsample.h"

namespace sundog {
namespace {

/// A pass over the whole image.
Pass whole_pass(const GrowingFilm& film, u32 first_sample, u32 sample_count, bool surfaces) {
  Pass pass;
  pass.width = film.film.width, pass.height = film.film.height;
  pass.first_sample = first_sample, pass.sample_count = sample_count;
  pass.surfaces = surfaces;
  return pass;
}

/// Whether two neighbours show different surfaces, or colours.
bool differ(const Film& film, std::size_t a, std::size_t b, float threshold) {
  constexpr float least_cosine = 0.9f;
  return !same_surface(film, a, b, least_cosine) ||
         contrast(color_at(film, a), color_at(film, b)) > threshold;
}

/// The samples that each pixel gets of an adaptive frame.
u32 first_level(const SamplingPlan& plan) {
  return std::min(static_cast<u32>(std::max(1, plan.settings.first_samples)), plan.samples);
}

/// Marks both of each pair of neighbours that differ.
void mark_differences(const GrowingFilm& film, float threshold, std::vector<std::uint8_t>& marked) {
  const auto width = static_cast<std::size_t>(film.film.width), all = film.taken.size();
  const auto compare = [&](std::size_t a, std::size_t b) {
    if (b < all && differ(film.film, a, b, threshold)) marked[a] = marked[b] = 1;
  };
  for (std::size_t p = 0; p < all; ++p) {
    if (p % width + 1 < width) compare(p, p + 1);
    compare(p, p + width);
  }
}

/// The pixels with `level` samples that need more. Samples go where each lowers the picture's squared error
/// most: for n samples the threshold is sqrt(n / 2) times as high.
std::vector<u32> unconverged(const GrowingFilm& film, const SamplingPlan& plan, u32 level,
                             const std::vector<float>& squares) {
  const auto threshold = static_cast<float>(plan.settings.threshold);
  const float most = threshold * threshold * static_cast<float>(level) / 2;
  std::vector<std::uint8_t> marked(film.taken.size());
  for (std::size_t p = 0; p < squares.size(); ++p) marked[p] = !(squares[p] <= most);
  if (level == first_level(plan) && plan.settings.surfaces)
    mark_differences(film, static_cast<float>(plan.settings.contrast) * threshold, marked);
  std::vector<u32> indices;
  for (std::size_t p = 0; p < marked.size(); ++p)
    if (marked[p] && film.taken[p] == level) indices.push_back(static_cast<u32>(p));
  return indices;
}

/// Those of the greatest errors, so that the frame's samples stay within the budget.
void keep_budget(const GrowingFilm& film, const SamplingPlan& plan, u32 more,
                 const std::vector<float>& squares, std::vector<u32>& indices) {
  if (!(plan.settings.budget > 0)) return;
  const double spent = std::accumulate(film.taken.begin(), film.taken.end(), 0.0);
  const double left = plan.settings.budget * static_cast<double>(film.taken.size()) - spent;
  const auto most = static_cast<std::size_t>(std::max(0.0, left / more));
  if (indices.size() <= most) return;
  const auto worse = [&](u32 a, u32 b) { return squares[a] != squares[b] ? squares[a] > squares[b] : a < b; };
  std::ranges::nth_element(indices, indices.begin() + static_cast<std::ptrdiff_t>(most), worse);
  indices.resize(most);
}

/// The next doubling of samples; each pixel has `level` of them or has stopped before.
std::optional<Pass> double_samples(const GrowingFilm& film, const SamplingPlan& plan, u32 level) {
  if (level >= plan.samples) return std::nullopt;
  u32 next = std::min(2 * level, plan.samples);
  const bool adaptive = plan.settings.threshold > 0;
  if (adaptive && level < first_level(plan)) next = std::min(next, first_level(plan));
  if (!adaptive || level < first_level(plan)) return whole_pass(film, level, next - level, false);
  const std::vector<float> squares = expected_squares(film, level);
  std::vector<u32> indices = unconverged(film, plan, level, squares);
  keep_budget(film, plan, next - level, squares, indices);
  if (indices.empty()) return std::nullopt;
  return list_pass(std::move(indices), film.film.width, level, next - level);
}

std::optional<Pass> more_samples(const GrowingFilm& film, const SamplingPlan& plan) {
  if (film.stage == 0) return whole_pass(film, 0, 1, plan.surfaces || needs_surfaces(plan.settings));
  const u32 level = *std::ranges::max_element(film.taken);
  if (plan.noise > 0 && mean_error(film) < plan.noise) return std::nullopt;
  return double_samples(film, plan, level);
}

}  // namespace

bool in_passes(const Sampling& settings) {
  return settings.threshold > 0 || settings.progressive || settings.subsample;
}

bool needs_surfaces(const Sampling& settings) {
  return (settings.threshold > 0 && settings.surfaces) || settings.subsample;
}

double mean_error(const GrowingFilm& film) {
  const std::vector<float> errors = pixel_errors(film);
  return std::accumulate(errors.begin(), errors.end(), 0.0) / static_cast<double>(errors.size());
}

std::optional<Pass> next_pass(GrowingFilm& film, const SamplingPlan& plan) {
  if (plan.settings.subsample) return next_subsampling_pass(film, plan);
  return more_samples(film, plan);
}

}  // namespace sundog
