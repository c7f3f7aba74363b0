// Sums octaves of rotated noise, or reads the picture or formula, row by row in parallel; computes normals
// from neighbouring heights.
#include "scene/procedural/terrain.h"

#include <tbb/parallel_for.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "scene/procedural/ice_block.h"
#include "scene/procedural/random.h"

namespace sundog {

namespace {

using glm::dvec2;
using glm::dvec3;

double smooth(double low, double high, double x) {
  const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

double height_at(const Terrain& terrain, const dvec2& p) {
  double sum = 0, share = 1, weight = 1;
  dvec3 at(p.x / terrain.feature, 0.5, p.y / terrain.feature);
  for (int octave = 0; octave < terrain.octaves; ++octave) {
    const double noise = procedural::gradient_noise(terrain.seed + static_cast<std::uint64_t>(octave), at);
    const double ridge = 1 - 3 * std::abs(noise), hill = noise;
    if (octave == 0) {
      // The hills stand in a plain; ridges rise where the hills are high.
      sum = hill + terrain.ridges * (smooth(-0.25, 0.6, hill) - hill);
      weight = 1 + terrain.ridges * (smooth(-0.2, 0.35, hill) - 1);
    } else {
      const double value = hill + terrain.ridges * (0.9 * ridge - hill);
      sum += share * weight * value;
      weight *= 1 + terrain.ridges * (std::clamp(0.55 + 0.45 * ridge, 0.0, 1.0) - 1);
    }
    share *= 0.5;
    // Rotated by the angle with cosine 4/5 and sine 3/5, so that the octaves' lattices do not coincide.
    at = {2 * (0.8 * at.x - 0.6 * at.z) + 17, 0.5, 2 * (0.6 * at.x + 0.8 * at.z) + 31};
  }
  return sum;
}

/// The picture at (u, v) in [0, 1], v from its top, interpolated bilinearly between the pixels' centres.
double value_at(const Image& picture, double u, double v) {
  const auto at = [](double share, int count) { return std::clamp(share * count - 0.5, 0.0, count - 1.0); };
  const double x = at(u, picture.width), y = at(v, picture.height);
  const int left = static_cast<int>(x), top = static_cast<int>(y);
  const auto pixel = [&](int dx, int dy) {
    const float* c =
        picture.pixel(std::min(left + dx, picture.width - 1), std::min(top + dy, picture.height - 1));
    return (double(c[0]) + double(c[1]) + double(c[2])) / 3;
  };
  return glm::mix(glm::mix(pixel(0, 0), pixel(1, 0), x - left), glm::mix(pixel(0, 1), pixel(1, 1), x - left),
                  y - top);
}

/// Computes the heights of a row of places with equal z.
void follow_formula(const LoweredPattern& formula, std::span<const dvec2> places, double* heights) {
  GraphProgram program(formula.graph, formula.values);
  for (const dvec2& place : places) {
    const dvec3 p(place.x, 0, place.y);
    const auto input = [&](int index) { return index < 3 ? p[index] : 0.0; };
    const double height = program.run([&](int index) { return input(index - formula_input::p); }).front();
    if (!(std::abs(height) <= 1e6))
      throw GenerateError(
          fmt::format("the formula has no height up to 1e6 at x = {:.4g}, z = {:.4g}", p.x, p.z));
    *heights++ = height;
  }
}

/// Rescales the heights to 0 .. the terrain's height.
void even_out(const Terrain& terrain, std::vector<double>& heights) {
  const auto [low, high] = std::ranges::minmax(heights);
  for (double& h : heights) h = high > low ? (h - low) * (terrain.height / (high - low)) : 0;
}

}  // namespace

Mesh make_terrain(const Terrain& terrain) {
  const double longer = std::max(terrain.size.x, terrain.size.y);
  const auto cells = [&](double side) {
    return std::max<std::size_t>(1, static_cast<std::size_t>(std::ceil(terrain.cells * side / longer)));
  };
  const std::size_t nx = cells(terrain.size.x), nz = cells(terrain.size.y);
  const auto place = [&](std::size_t i, std::size_t k) {
    return dvec2((double(i) / double(nx) - 0.5) * terrain.size.x,
                 (double(k) / double(nz) - 0.5) * terrain.size.y);
  };
  std::vector<double> heights((nx + 1) * (nz + 1));
  const auto height_of = [&](std::size_t i, std::size_t k) {
    if (!terrain.picture) return height_at(terrain, place(i, k));
    return terrain.height * value_at(*terrain.picture, double(i) / double(nx), double(k) / double(nz));
  };
  tbb::parallel_for(std::size_t{0}, nz + 1, [&](std::size_t k) {
    double* const row = &heights[k * (nx + 1)];
    std::vector<dvec2> places;
    for (std::size_t i = 0; terrain.formula && i <= nx; ++i) places.push_back(place(i, k));
    if (terrain.formula) return follow_formula(*terrain.formula, places, row);
    for (std::size_t i = 0; i <= nx; ++i) row[i] = height_of(i, k);
  });
  if (!terrain.picture && !terrain.formula) even_out(terrain, heights);

  const auto height = [&](std::size_t i, std::size_t k) { return heights[k * (nx + 1) + i]; };
  Mesh mesh;
  for (std::size_t k = 0; k <= nz; ++k)
    for (std::size_t i = 0; i <= nx; ++i) {
      const std::size_t left = i > 0 ? i - 1 : i, right = std::min(i + 1, nx), back = k > 0 ? k - 1 : k,
                        front = std::min(k + 1, nz);
      const double dx = (height(right, k) - height(left, k)) / (place(right, k).x - place(left, k).x);
      const double dz = (height(i, front) - height(i, back)) / (place(i, front).y - place(i, back).y);
      const dvec2 p = place(i, k);
      mesh.positions.values().emplace_back(p.x, height(i, k), p.y);
      mesh.normals.values().emplace_back(procedural::normalized({-dx, 1, -dz}));
      mesh.uvs.values().emplace_back(double(i) / double(nx), 1 - double(k) / double(nz));
    }
  for (std::size_t k = 0; k < nz; ++k)
    for (std::size_t i = 0; i < nx; ++i) {
      const auto a = static_cast<unsigned>(k * (nx + 1) + i), b = a + static_cast<unsigned>(nx) + 1;
      mesh.triangles.values().emplace_back(a, b, b + 1);
      mesh.triangles.values().emplace_back(a, b + 1, a + 1);
    }
  return mesh;
}

}  // namespace sundog
