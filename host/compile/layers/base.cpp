// See base.h.
#include "compile/layers/base.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cmath>

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

/// Of facets as wide across as along: the same for all materials.
const GainGrid& round_gains() {
  // Its own tasks alone run meanwhile: another's might ask for the grid.
  static const GainGrid grid = tbb::this_task_arena::isolate([] { return make_gains(0); });
  return grid;
}

/// As the kernels ask.
bool is_round(double anisotropy) { return float(1 - anisotropy) == 1; }

/// The gains of one anisotropy, which the materials of a scene share.
const GainGrid& gain_grid(double anisotropy, LayerRows& rows) {
  if (is_round(anisotropy)) return round_gains();
  const auto found = rows.gains.find(anisotropy);
  return found != rows.gains.end() ? found->second
                                   : rows.gains.emplace(anisotropy, make_gains(anisotropy)).first->second;
}

/// Between a step and the next, as the kernels have it.
FacetGains gains_at(double y, const GainGrid& grid) {
  const auto step = static_cast<std::size_t>(y);
  const double by_width = LAYER_GRID_PART(y, double(step)), part = step == 0 ? by_width * by_width : by_width;
  FacetGains gains;
  for (std::size_t row = 0; row < gains.size(); ++row)
    for (std::size_t i = 0; i < gains[row].size(); ++i)
      gains[row][i] = std::lerp(grid[step][row][i], grid[step + 1][row][i], part);
  return gains;
}

std::array<BaseInterface, steps> make_steps(double anisotropy, const GainGrid& gains,
                                            const BaseSurroundings& around) {
  std::array<BaseInterface, steps> made;
  std::array<double, steps - 1> scales;
  tbb::parallel_for(std::size_t{0}, steps, [&](std::size_t i) {
    made[i] = base_interface(widths_at(double(i), anisotropy), gains[i], around);
    if (i + 1 == steps) return;
    const double middle = double(i) + 0.5;
    scales[i] = facet_albedo(widths_at(middle, anisotropy), gains_at(middle, gains), around.interface).scale;
  });
  for (std::size_t i = 0; i + 1 < steps; ++i)
    for (BaseInterface* step : {&made[i], &made[i + 1]})
      step->shine_scale = std::min(step->shine_scale, scales[i]);
  return made;
}

std::vector<double> grid_key(double anisotropy, const BaseSurroundings& around) {
  std::vector<double> key{anisotropy, around.interface.eta, around.interface.film, around.tint,
                          around.matte_roughness};
  for (const AlbedoRow* row : {&around.interface.film_row, &around.above})
    key.insert(key.end(), row->begin(), row->end());
  return key;
}

}  // namespace

FacetWidths wide_enough(const FacetWidths& widths) {
  constexpr double least = LEAST_LAYER_ALPHA;
  return {float(std::max(widths.x, least)), float(std::max(widths.y, least))};
}

BaseInterface base_interface(const FacetWidths& widths, const FacetGains& gains,
                             const BaseSurroundings& around) {
  const FacetAlbedo shine = facet_albedo(widths, gains, around.interface);
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

u32 add_layer_grid(double anisotropy, const BaseSurroundings& around, LayerRows& rows) {
  const auto [found, added] = rows.grids.try_emplace(grid_key(anisotropy, around), u32(rows.values.size()));
  if (!added) return found->second;
  const GainGrid& gains = gain_grid(anisotropy, rows);
  const std::array<BaseInterface, steps> made = make_steps(anisotropy, gains, around);
  std::vector<float>& to = rows.values;
  for (const BaseInterface& step : made)
    for (const double number : {step.straight, step.shine_scale, step.matte_scale, step.matte_scale_bare})
      to.push_back(float(number));
  for (std::size_t i = 0; i < steps; ++i) {
    to.insert(to.end(), made[i].past.begin(), made[i].past.end());
    for (std::size_t row = 0; row < (is_round(anisotropy) ? 1 : LAYER_TURNS); ++row)
      to.insert(to.end(), gains[i][row].begin(), gains[i][row].end());
  }
  return found->second;
}

}  // namespace sundog
