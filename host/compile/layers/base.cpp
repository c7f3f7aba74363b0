// Turns facet albedos (facets.h) into the light past the base and the scales of lobes, for each step of a
// grid in parallel; equal grids share their rows.
#include "compile/layers/base.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace sundog {
namespace {

constexpr std::size_t steps = LAYER_GRID_STEPS;

FacetWidths widths_at(double step, double anisotropy) {
  return wide_enough(facet_widths(step / (steps - 1), anisotropy));
}

GainGrid make_gains(double anisotropy) {
  GainGrid grid;
  for (std::size_t i = 0; i < steps; ++i) grid[i] = facet_gains(widths_at(double(i), anisotropy));
  return grid;
}

/// Isotropic facets: the same for all materials.
const GainGrid& round_gains() {
  // Isolated, because a stolen task might request the grid.
  static const GainGrid grid = tbb::this_task_arena::isolate([] { return make_gains(0); });
  return grid;
}

/// Uses the kernels' test.
bool is_round(double anisotropy) { return float(1 - anisotropy) == 1; }

/// The gains of one anisotropy, shared by a scene's materials.
const GainGrid& gain_grid(double anisotropy, LayerRows& rows) {
  if (is_round(anisotropy)) return round_gains();
  const auto found = rows.gains.find(anisotropy);
  return found != rows.gains.end() ? found->second
                                   : rows.gains.emplace(anisotropy, make_gains(anisotropy)).first->second;
}

/// The parameter of a grid's steps: roughness, or coat weight.
struct GridSteps {
  double anisotropy;
  std::span<const FacetWidths> by_coat;  // one per step; empty in a grid by roughness

  FacetWidths widths_at(double y) const {
    if (by_coat.empty()) return sundog::widths_at(y, anisotropy);
    const auto step = std::min(static_cast<std::size_t>(y), steps - 2);
    const FacetWidths &a = by_coat[step], &b = by_coat[step + 1];
    // Roughness, the square root of the width, is linear between steps.
    const auto between = [&](double from, double to) {
      const double root = std::lerp(std::sqrt(from), std::sqrt(to), y - double(step));
      return root * root;
    };
    return {between(a.x, b.x), between(a.y, b.y)};
  }
  /// Position between steps, as in kernels.
  double part_at(double y) const {
    const auto step = static_cast<std::size_t>(y);
    if (!by_coat.empty()) return y - double(step);
    const double by_width = LAYER_GRID_PART(y, double(step));
    return step == 0 ? by_width * by_width : by_width;
  }
};

FacetGains gains_at(double y, const GridSteps& of, const GainGrid& grid) {
  const auto step = static_cast<std::size_t>(y);
  const double part = of.part_at(y);
  FacetGains gains;
  for (std::size_t row = 0; row < gains.size(); ++row)
    for (std::size_t i = 0; i < gains[row].size(); ++i)
      gains[row][i] = std::lerp(grid[step][row][i], grid[step + 1][row][i], part);
  return gains;
}

/// The largest shine_scale per step such that facets between it and its neighbours reflect at most all light.
std::array<double, steps> greatest_scales(const GridSteps& of, const GainGrid& gains) {
  std::array<double, steps> scales;
  scales.fill(1);
  tbb::parallel_for(std::size_t{0}, steps - 1, [&](std::size_t i) {
    const double middle = double(i) + 0.5;
    scales[i] = facet_albedo(of.widths_at(middle), gains_at(middle, of, gains), {1, 0, {}}).scale;
  });
  for (std::size_t i = steps - 1; i > 0; --i) scales[i] = std::min(scales[i], scales[i - 1]);
  return scales;
}

/// Computes all steps of a grid; `around` has one entry for all steps, or one per step.
std::array<BaseInterface, steps> make_steps(const GridSteps& of, const GainGrid& gains,
                                            const std::array<double, steps>& scales,
                                            std::span<const BaseSurroundings> around) {
  std::array<BaseInterface, steps> made;
  tbb::parallel_for(std::size_t{0}, steps, [&](std::size_t i) {
    const BaseSurroundings& here = around[std::min(i, around.size() - 1)];
    made[i] = base_interface(facet_albedo(of.widths_at(double(i)), gains[i], here.interface), here);
    made[i].shine_scale = std::min(made[i].shine_scale, scales[i]);
  });
  return made;
}

std::vector<double> grid_key(double anisotropy, std::span<const BaseSurroundings> around) {
  std::vector<double> key{anisotropy};
  for (const BaseSurroundings& one : around) {
    key.insert(key.end(), {one.interface.eta, one.interface.film, one.tint, one.matte_roughness});
    for (const AlbedoRow* row : {&one.interface.film_row, &one.above})
      key.insert(key.end(), row->begin(), row->end());
  }
  return key;
}

void write_grid(const std::array<BaseInterface, steps>& made, const GainGrid& gains, double anisotropy,
                std::vector<float>& to) {
  for (const BaseInterface& step : made)
    for (const double number : {step.straight, step.shine_scale, step.matte_scale, step.matte_scale_bare})
      to.push_back(float(number));
  for (std::size_t i = 0; i < steps; ++i) {
    to.insert(to.end(), made[i].past.begin(), made[i].past.end());
    for (std::size_t row = 0; row < (is_round(anisotropy) ? 1 : LAYER_TURNS); ++row)
      to.insert(to.end(), gains[i][row].begin(), gains[i][row].end());
  }
}

/// Computes equal widths of neighbours only once; under a smooth coat most are equal.
GainGrid gains_of(std::span<const FacetWidths> widths) {
  GainGrid gains;
  for (std::size_t i = 0; i < steps; ++i) {
    const bool again = i > 0 && widths[i].x == widths[i - 1].x && widths[i].y == widths[i - 1].y;
    gains[i] = again ? gains[i - 1] : facet_gains(widths[i]);
  }
  return gains;
}

}  // namespace

FacetWidths wide_enough(const FacetWidths& widths) {
  constexpr double least = LEAST_LAYER_ALPHA;
  return {float(std::max(widths.x, least)), float(std::max(widths.y, least))};
}

BaseInterface base_interface(const FacetAlbedo& shine, const BaseSurroundings& around) {
  BaseInterface base;
  AlbedoRow past_all;
  for (std::size_t i = 0; i < LAYER_STEPS; ++i) {
    base.past[i] = 1 - std::min(around.tint * shine.of_interface[i], 1.0);
    past_all[i] = around.above[i] * base.past[i];
  }
  base.straight = std::min(shine.of_interface.back(), 1.0);
  base.shine_scale = shine.scale;
  base.matte_scale = 1 / matte_albedo(around.matte_roughness, past_all);
  base.matte_scale_bare = 1 / matte_albedo(around.matte_roughness, base.past);
  return base;
}

u32 layer_grid_size(double anisotropy) {
  return LAYER_GRID_STEPS *
         (LAYER_GRID_NUMBERS + LAYER_STEPS * (is_round(anisotropy) ? 2u : 1u + LAYER_TURNS));
}

u32 add_roughness_grids(double anisotropy, std::span<const BaseSurroundings> around, LayerRows& rows) {
  const auto [found, added] = rows.grids.try_emplace(grid_key(anisotropy, around), u32(rows.values.size()));
  if (!added) return found->second;
  const GainGrid& gains = gain_grid(anisotropy, rows);
  const GridSteps of{anisotropy, {}};
  const std::array<double, steps> scales = greatest_scales(of, gains);
  for (const BaseSurroundings& one : around)
    write_grid(make_steps(of, gains, scales, {&one, 1}), gains, anisotropy, rows.values);
  return found->second;
}

u32 add_coat_grid(double anisotropy, std::span<const FacetWidths> widths,
                  std::span<const BaseSurroundings> around, LayerRows& rows) {
  std::vector<double> key = grid_key(anisotropy, around);
  for (const FacetWidths& one : widths) key.insert(key.end(), {one.x, one.y});
  const auto [found, added] = rows.grids.try_emplace(std::move(key), u32(rows.values.size()));
  if (!added) return found->second;
  const GainGrid gains = gains_of(widths);
  const GridSteps of{anisotropy, widths};
  write_grid(make_steps(of, gains, greatest_scales(of, gains), around), gains, anisotropy, rows.values);
  return found->second;
}

}  // namespace sundog
