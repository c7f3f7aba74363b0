// Samples the corners, casts surface rays between corners that agree, samples pixels that differ and the
// pixels around surprises, then interpolates the rest.
#include "render/plan/subsample.h"

#include <algorithm>
#include <array>
#include <span>

#include "render/plan/passes.h"
#include "render/plan/pixel_rules.h"

namespace sundog {
namespace {

// The least cosine between normals that counts as flat, for pixels two apart.
constexpr float even_cosine = 0.98f;

/// The image as cells between corners two pixels apart, or one at the far edges.
struct Grid {
  const Film& film;
  float threshold;
  std::span<const std::uint8_t> panes = {};  // SamplingPlan::panes
  int width = film.width, height = film.height;

  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
  bool is_corner(int x, int y) const { return on_line(x, width) && on_line(y, height); }
  static bool on_line(int x, int size) { return x % 2 == 0 || x == size - 1; }

  /// The corners around a pixel; duplicated on a line between two cells, or four times the pixel itself.
  std::array<std::size_t, 4> corners(int x, int y) const {
    const int left = on_line(x, width) ? x : x - 1, right = on_line(x, width) ? x : x + 1;
    const int top = on_line(y, height) ? y : y - 1, bottom = on_line(y, height) ? y : y + 1;
    return {at(left, top), at(right, top), at(left, bottom), at(right, bottom)};
  }

  /// Whether the pixel's ray meets a pane, behind which the AOVs show no surface.
  bool meets_pane(std::size_t p) const {
    const float material = film.aovs[film.layout.vectors() * p + 2].w;
    return material >= 0 && static_cast<std::size_t>(material) < panes.size() &&
           panes[static_cast<std::size_t>(material)];
  }

  /// Whether four corners agree.
  bool agree(const std::array<std::size_t, 4>& four) const {
    if (meets_pane(four[0])) return false;
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t k = i + 1; k < 4; ++k) {
        if (!same_surface(film, four[i], four[k], even_cosine)) return false;
        if (contrast(color_at(film, four[i]), color_at(film, four[k])) > threshold) return false;
      }
    return true;
  }

  /// Whether all cells that contain a pixel agree.
  bool between_alike(int x, int y) const {
    const int u = on_line(x, width) ? 1 : 0, v = on_line(y, height) ? 1 : 0;
    for (int dy = -v; dy <= v; dy += 2)
      for (int dx = -u; dx <= u; dx += 2) {
        const int cx = x + dx, cy = y + dy;
        if (cx < 0 || cy < 0 || cx >= width || cy >= height) continue;
        if (!agree(corners(cx, cy))) return false;
      }
    return true;
  }

  Color promised(int x, int y) const {
    Color sum;
    for (const std::size_t corner : corners(x, y)) {
      const Color color = color_at(film, corner);
      sum.r += 0.25f * color.r, sum.g += 0.25f * color.g, sum.b += 0.25f * color.b;
    }
    return sum;
  }
};

/// The pixels for which `wanted` is true, in list order.
template <class Wanted>
std::vector<u32> pick_any(const Grid& grid, const Wanted& wanted) {
  std::vector<u32> pixels = all_pixels(grid.width, grid.height);
  std::erase_if(pixels, [&](u32 pixel) {
    return !wanted(static_cast<int>(pixel & 0xffffu), static_cast<int>(pixel >> 16));
  });
  return pixels;
}

/// The pixels that are not corners and for which `wanted` is true.
template <class Wanted>
std::vector<u32> pick(const Grid& grid, const Wanted& wanted) {
  return pick_any(grid, [&](int x, int y) { return !grid.is_corner(x, y) && wanted(x, y); });
}

/// Whether a pixel's surface matches all its corners' surfaces.
bool fits_corners(const Grid& grid, int x, int y) {
  for (const std::size_t corner : grid.corners(x, y))
    if (!same_surface(grid.film, corner, grid.at(x, y), even_cosine)) return false;
  return true;
}

/// Whether a sampled pixel's light differs from its corners' light on the same surface: the edge of a shadow
/// or reflection, which may continue between nearby corners.
bool surprises(const Grid& grid, int x, int y) {
  const std::size_t p = grid.at(x, y);
  const Film& film = grid.film;
  if (film.states[p] != PixelState::sampled || grid.is_corner(x, y)) return false;
  return contrast(color_at(film, p), grid.promised(x, y)) > grid.threshold;
}

std::vector<u32> near_surprises(const Grid& grid) {
  std::vector<std::uint8_t> wanted(grid.film.pixels());
  for (int y = 0; y < grid.height; ++y)
    for (int x = 0; x < grid.width; ++x) {
      if (!surprises(grid, x, y)) continue;
      for (int v = std::max(0, y - 1); v <= std::min(grid.height - 1, y + 1); ++v)
        for (int u = std::max(0, x - 1); u <= std::min(grid.width - 1, x + 1); ++u) wanted[grid.at(u, v)] = 1;
    }
  return pick(grid, [&](int x, int y) {
    const std::size_t p = grid.at(x, y);
    return wanted[p] && grid.film.states[p] != PixelState::sampled;
  });
}

/// Copies mattes to an interpolated pixel from a corner, which shows the same surface, scaled to the pixel's
/// coverage.
void take_mattes(Film& film, std::size_t corner, std::size_t p) {
  if (!film.layout.mattes) return;
  const float share = film.sums[corner].w > 0 ? film.sums[p].w / film.sums[corner].w : 0;
  float4* pixel = &film.aovs[film.layout.vectors() * p + film.layout.surfaces];
  const float4* of = &film.aovs[film.layout.vectors() * corner + film.layout.surfaces];
  // A pair is an id and a share.
  for (std::size_t k = 0; k < MATTE_VECTORS; ++k)
    pixel[k] = {of[k].x, of[k].y * share, of[k].z, of[k].w * share};
}

/// Averages the corners' light parts, as promised() averages their colours.
void take_light(Film& film, const std::array<std::size_t, 4>& corners, std::size_t p) {
  if (!film.layout.light) return;
  const auto light_of = [&](std::size_t at) {
    return &film.aovs[film.layout.vectors() * at + film.layout.first_light()];
  };
  for (std::size_t k = 0; k < LIGHT_VECTORS; ++k) {
    float4 sum{};
    for (const std::size_t corner : corners) {
      const float share = film.weights[corner] > 0 ? 0.25f / film.weights[corner] : 0;
      const float4& of = light_of(corner)[k];
      sum = {sum.x + share * of.x, sum.y + share * of.y, sum.z + share * of.z, sum.w + share * of.w};
    }
    light_of(p)[k] = sum;
  }
}

/// Sets pixels without samples to the mean of those corners that have some.
void interpolate(Film& film, const Grid& grid) {
  for (int y = 0; y < grid.height; ++y)
    for (int x = 0; x < grid.width; ++x) {
      const std::size_t p = grid.at(x, y);
      if (film.states[p] == PixelState::sampled || grid.is_corner(x, y)) continue;
      const auto sampled = [&](std::size_t corner) { return film.states[corner] == PixelState::sampled; };
      if (!std::ranges::all_of(grid.corners(x, y), sampled)) continue;
      const Color color = grid.promised(x, y);
      float coverage = 0;
      for (const std::size_t corner : grid.corners(x, y))
        coverage += 0.25f * film.sums[corner].w / std::max(film.weights[corner], 1.0f);
      film.sums[p] = {color.r, color.g, color.b, coverage};
      film.weights[p] = 1;
      take_mattes(film, grid.corners(x, y)[0], p);
      take_light(film, grid.corners(x, y), p);
      film.done[p] = 1;
      film.states[p] = PixelState::interpolated;
    }
}

Pass first_samples(const std::vector<u32>& pixels, u32 samples, bool surfaces) {
  Pass pass = list_pass(pixels, 0, samples);
  pass.surfaces = surfaces;
  return pass;
}

Pass corner_pass(const Film& film, u32 samples) {
  const Grid grid{film, 0};
  return first_samples(pick_any(grid, [&](int x, int y) { return grid.is_corner(x, y); }), samples, true);
}

}  // namespace

void interpolate_rest(Film& film) { interpolate(film, Grid{film, 0}); }

std::optional<Pass> next_subsampling_pass(Film& film, const SamplingPlan& plan) {
  const Grid grid{film, static_cast<float>(plan.settings.subsample_contrast), plan.panes};
  if (film.step == 0) {
    ++film.step;
    return corner_pass(film, plan.samples);
  }
  const auto unseen = [&](std::size_t p) { return film.states[p] == PixelState::empty; };
  if (film.step == 1) {
    ++film.step;
    const std::vector<u32> look = pick(grid, [&](int x, int y) {
      return unseen(grid.at(x, y)) && (plan.surfaces || grid.between_alike(x, y));
    });
    if (!look.empty()) return first_samples(look, 0, true);
  }
  if (film.step == 2) {
    ++film.step;
    const std::vector<u32> other = pick(grid, [&](int x, int y) {
      return !grid.between_alike(x, y) || (!unseen(grid.at(x, y)) && !fits_corners(grid, x, y));
    });
    if (!other.empty()) return first_samples(other, plan.samples, plan.sums);
  }
  ++film.step;
  const std::vector<u32> more = near_surprises(grid);
  if (!more.empty()) return first_samples(more, plan.samples, plan.sums);
  interpolate(film, grid);
  return std::nullopt;
}

}  // namespace sundog
