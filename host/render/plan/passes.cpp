// Doubles the samples of pixels whose error exceeds the threshold, scaled by cost, within the budget;
// subsample.h plans frames that interpolate.
#include "render/plan/passes.h"

#include <algorithm>
#include <numeric>

#include "render/plan/convergence.h"
#include "render/plan/pixel_rules.h"
#include "render/plan/subsample.h"
#include "scene/integrators.h"

namespace sundog {
namespace {

/// A pass over the whole image.
Pass whole_pass(const Film& film, u32 first_sample, u32 sample_count, bool surfaces) {
  Pass pass;
  pass.width = film.width, pass.height = film.height;
  pass.first_sample = first_sample, pass.sample_count = sample_count;
  pass.surfaces = surfaces;
  return pass;
}

/// Whether two neighbours show different surfaces or colours.
bool differ(const Film& film, std::size_t a, std::size_t b, float threshold) {
  constexpr float least_cosine = 0.9f;
  return !same_surface(film, a, b, least_cosine) ||
         contrast(color_at(film, a), color_at(film, b)) > threshold;
}

/// Initial samples per pixel of an adaptive frame.
u32 first_level(const SamplingPlan& plan) {
  return std::min(static_cast<u32>(std::max(1, plan.settings.first_samples)), plan.samples);
}

/// Keeps the pixels with the largest errors such that `more` samples each stay within the budget, in mean
/// samples per pixel.
void keep_budget(const Film& film, double budget, u32 more, const std::vector<float>& squares,
                 std::vector<std::size_t>& kept) {
  const double spent = std::accumulate(film.taken.begin(), film.taken.end(), 0.0);
  const double left = budget * static_cast<double>(film.pixels()) - spent;
  const auto most = static_cast<std::size_t>(std::max(0.0, left / more));
  if (kept.size() <= most) return;
  const auto worse = [&](std::size_t a, std::size_t b) {
    return squares[a] != squares[b] ? squares[a] > squares[b] : a < b;
  };
  std::ranges::nth_element(kept, kept.begin() + static_cast<std::ptrdiff_t>(most), worse);
  kept.resize(most);
  std::ranges::sort(kept);
}

/// Whether a pixel differs from a horizontal or vertical neighbour.
bool differs_from_neighbors(const Film& film, u32 pixel, float threshold) {
  const auto width = static_cast<std::size_t>(film.width), height = static_cast<std::size_t>(film.height);
  const std::size_t x = pixel & 0xffffu, y = pixel >> 16, p = y * width + x;
  return (x > 0 && differ(film, p - 1, p, threshold)) ||
         (x + 1 < width && differ(film, p, p + 1, threshold)) ||
         (y > 0 && differ(film, p - width, p, threshold)) ||
         (y + 1 < height && differ(film, p, p + width, threshold));
}

/// The pixels of the last pass, with `level` samples each, that need `more`. Samples go where each reduces
/// the picture's squared error most: at n samples the threshold is sqrt(n / 2) times as high. A budget
/// selects the largest errors.
std::vector<u32> unconverged(const Film& film, const SamplingPlan& plan, const Pass& last, u32 level,
                             u32 more) {
  const auto threshold = static_cast<float>(plan.settings.threshold);
  const bool by_surfaces = level == first_level(plan) && plan.settings.surfaces;
  std::vector<float> limits = block_costs(film);
  for (float& limit : limits) limit *= threshold * threshold * static_cast<float>(level) / 2;
  if (level == 1 && last.pixels.empty() && !by_surfaces && plan.settings.budget == 0)
    return pixels_above(limits, expected_squares_of_one(film), film.width, film.height);
  std::vector<u32> pixels = pixels_of(last);
  std::vector<float> squares =
      plan.noisy ? pooled_squares(film, pixels, level) : expected_squares(film, pixels, level);
  const float contrast = static_cast<float>(plan.settings.contrast) * threshold;
  const u32 columns = cost_blocks_along(film.width);
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const u32 x = pixels[i] & 0xffffu, y = pixels[i] >> 16;
    const float limit = limits[y / cost_block * columns + x / cost_block];
    const bool is_above = squares[i] > limit;
    squares[i] /= limit;
    if (is_above || (by_surfaces && differs_from_neighbors(film, pixels[i], contrast))) kept.push_back(i);
  }
  if (plan.settings.budget > 0) keep_budget(film, plan.settings.budget, more, squares, kept);
  for (std::size_t i = 0; i < kept.size(); ++i) pixels[i] = pixels[kept[i]];
  pixels.resize(kept.size());
  return pixels;
}

/// Doubles the samples of pixels that have not converged; the last pass's pixels have `level` samples.
std::optional<Pass> double_samples(const Film& film, const SamplingPlan& plan, const Pass& last) {
  const u32 level = last.first_sample + last.sample_count;
  if (level >= plan.samples) return std::nullopt;
  u32 next = std::min(2 * level, plan.samples);
  const bool adaptive = plan.settings.threshold > 0;
  if (adaptive && level < first_level(plan)) next = std::min(next, first_level(plan));
  if (!adaptive || level < first_level(plan)) return whole_pass(film, level, next - level, plan.sums);
  const std::vector<u32> pixels = unconverged(film, plan, last, level, next - level);
  if (pixels.empty()) return std::nullopt;
  Pass pass = list_pass(pixels, level, next - level);
  pass.surfaces = plan.sums;
  return pass;
}

std::optional<Pass> more_samples(const Film& film, const SamplingPlan& plan, const Pass& last) {
  if (film.stage == 0) {
    Pass pass = whole_pass(film, 0, 1, plan.surfaces || needs_surfaces(plan.settings));
    pass.costs = plan.settings.threshold > 0;
    return pass;
  }
  if (plan.noise > 0 && mean_error(film) < plan.noise) return std::nullopt;
  return double_samples(film, plan, last);
}

bool is_zero(const float4& color) { return color.x == 0 && color.y == 0 && color.z == 0; }

bool has_texture(const MaterialMaps& maps, MapSlot slot) { return maps.slot[slot] != NO_TEXTURE; }

/// Marks materials through which the camera sees other surfaces straight on.
std::vector<std::uint8_t> clear_materials(const CompiledScene& scene) {
  constexpr u32 straight = MATERIAL_TRANSMITS | MATERIAL_THIN;
  std::vector<std::uint8_t> clear;
  for (const Material& material : scene.materials) {
    bool lets_through = !is_zero(material.transmission);
    if (material.maps != NO_MAPS) {
      const MaterialMaps& maps = scene.material_maps[material.maps];
      const bool open = maps.opacity < 1 || has_texture(maps, MAP_OPACITY);
      lets_through |= has_texture(maps, MAP_TRANSMISSION) || (open && maps.cutoff == 0);
    }
    clear.push_back((material.flags & straight) == straight && lets_through);
  }
  return clear;
}

}  // namespace

SamplingPlan plan_sampling(const CompiledScene& scene) {
  constexpr int least_through_lens = 4;  // one or two often miss the blur of a small light
  const int least =
      std::max(integrator_of(scene.integrator).least_samples, scene.features.lens ? least_through_lens : 1);
  SamplingPlan plan{.settings = scene.sampling,
                    .samples = scene.info.samples,
                    .noisy = least > 1,
                    .panes = clear_materials(scene)};
  plan.settings.first_samples = std::max(plan.settings.first_samples, least);
  return plan;
}

bool in_passes(const Sampling& settings) {
  return settings.threshold > 0 || settings.progressive || settings.subsample;
}

bool needs_surfaces(const Sampling& settings) {
  return (settings.threshold > 0 && settings.surfaces) || settings.subsample;
}

double mean_error(const Film& film) {
  const std::vector<float> errors = pixel_errors(film);
  return std::accumulate(errors.begin(), errors.end(), 0.0) / static_cast<double>(errors.size());
}

bool may_be_of(const SamplingPlan& plan, const Pass& pass) {
  if (!in_passes(plan.settings))
    return pass.pixels.empty() && pass.first_sample == 0 && pass.sample_count == plan.samples;
  const bool looks = plan.settings.subsample && pass.surfaces && pass.first_sample == 0;
  return (pass.sample_count > 0 || looks) && pass.sample_count <= plan.samples &&
         pass.first_sample <= plan.samples - pass.sample_count;
}

std::optional<Pass> next_pass(Film& film, const SamplingPlan& plan, const Pass& last) {
  if (!in_passes(plan.settings) && film.stage > 0) return std::nullopt;
  if (!in_passes(plan.settings)) return whole_pass(film, 0, plan.samples, plan.surfaces);
  if (plan.settings.subsample) return next_subsampling_pass(film, plan);
  return more_samples(film, plan, last);
}

}  // namespace sundog
