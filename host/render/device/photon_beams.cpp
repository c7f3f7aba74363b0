// Draws beams in proportion to the light that media scatter from them, and groups beams that lie together.
#include "render/device/photon_beams.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>

#include "shared/sampler.h"

namespace sundog {
namespace {

struct Beam {
  std::array<float4, 3> rows;
  glm::dvec3 begin, way;
  double length;
};

glm::dvec3 point_of(const float4& row) { return {row.x, row.y, row.z}; }

Beam beam_of(const std::array<float4, 3>& rows) {
  return {rows, point_of(rows[0]), glm::normalize(point_of(rows[1])), rows[0].w};
}

/// Selects the existing beams, in order; if there are more than `most`, draws that many at even steps of the
/// light that media scatter from them.
std::vector<Beam> draw_beams(std::span<const float4> beams, std::size_t most, u32 number) {
  const auto light_of = [&](std::size_t i) {
    const glm::dvec3 sum = point_of(beams[i - 2]) + point_of(beams[i - 1]);
    return std::isfinite(sum.x + sum.y + sum.z + beams[i].w) ? double(beams[i].w) : 0;
  };
  std::size_t count = 0;
  double all = 0;
  for (std::size_t i = 2; i < beams.size(); i += 3) {
    count += light_of(i) > 0;
    all += light_of(i);
  }
  const double step = count > most ? all / static_cast<double>(most) : 0;
  double next = step * hash_u32(number) * 0x1p-32, sum = 0;
  std::vector<Beam> drawn;
  for (std::size_t i = 2; i < beams.size(); i += 3) {
    const double light = light_of(i), times = step > 0 ? std::ceil((sum + light - next) / step) : 1;
    sum += light;
    if (!(light > 0 && times > 0)) continue;
    next += times * step;
    const auto factor = static_cast<float>(step > 0 ? times * step / light : 1);
    float4 flux = beams[i];
    flux.x *= factor, flux.y *= factor, flux.z *= factor;
    drawn.push_back(beam_of({beams[i - 2], beams[i - 1], flux}));
  }
  return drawn;
}

/// The coordinates of both ends; endless beams end at the distance `reach`.
std::array<double, 6> ends_of(const Beam& beam, double reach) {
  const glm::dvec3 &a = beam.begin, b = a + std::min(beam.length, reach) * beam.way;
  return {a.x, a.y, a.z, b.x, b.y, b.z};
}

/// Sorts beams so that each group's beams lie together: halves the list along the coordinate in which the
/// ends are farthest apart.
void sort_beams(std::span<Beam> beams, double reach) {
  if (beams.size() <= BEAM_GROUP) return;
  std::array<double, 6> low = ends_of(beams[0], reach), high = low;
  for (const Beam& beam : beams)
    for (std::size_t i = 0; const double value : ends_of(beam, reach)) {
      low[i] = std::min(low[i], value), high[i] = std::max(high[i], value);
      ++i;
    }
  std::size_t widest = 0;
  for (std::size_t i = 1; i < 6; ++i)
    if (high[i] - low[i] > high[widest] - low[widest]) widest = i;
  const std::size_t groups = (beams.size() + BEAM_GROUP - 1) / BEAM_GROUP, half = groups / 2 * BEAM_GROUP;
  std::ranges::nth_element(beams, beams.begin() + std::ptrdiff_t(half), {},
                           [&](const Beam& beam) { return ends_of(beam, reach)[widest]; });
  sort_beams(beams.first(half), reach);
  sort_beams(beams.subspan(half), reach);
}

/// Appends a group: the rows of the cone that encloses the beams and everything within `radius` of them, then
/// the beams' rows.
void append_group(std::span<const Beam> beams, double radius, std::vector<float4>& rows) {
  glm::dvec3 middle(0), axis(0);
  for (const Beam& beam : beams) middle += beam.begin / double(beams.size()), axis += beam.way;
  axis = glm::length(axis) > 0 ? glm::normalize(axis) : beams[0].way;
  double growth = 0, at_middle = 0;
  for (const Beam& beam : beams) {
    const double cosine = glm::dot(beam.way, axis);
    growth = std::max(growth, glm::length(beam.way - cosine * axis) / cosine);
    if (cosine < 0.1) at_middle = INFINITY;  // no cone holds beams of all directions
  }
  for (const Beam& beam : beams) {
    const glm::dvec3 to = beam.begin - middle;
    const double along = glm::dot(to, axis);
    at_middle = std::max(at_middle, glm::length(to - along * axis) - growth * along);
  }
  constexpr double margin = 1.01;
  const glm::vec3 point(middle), way(axis);
  rows.push_back({point.x, point.y, point.z, float(margin * (at_middle + radius * (1 + growth)))});
  rows.push_back({way.x, way.y, way.z, float(std::isfinite(at_middle) ? margin * growth : 0)});
  for (const Beam& beam : beams) rows.insert(rows.end(), beam.rows.begin(), beam.rows.end());
  rows.resize(rows.size() + 3 * (BEAM_GROUP - beams.size()));
}

}  // namespace

std::vector<float4> group_beams(std::span<const float4> beams, std::size_t most, u32 number, double radius) {
  std::vector<Beam> drawn = draw_beams(beams, most, number);
  double reach = 0;
  for (const Beam& beam : drawn)
    if (std::isfinite(beam.length)) reach = std::max(reach, beam.length);
  const std::size_t share = (drawn.size() + PHOTON_MAP_SAMPLES - 1) / PHOTON_MAP_SAMPLES,
                    groups = (share + BEAM_GROUP - 1) / BEAM_GROUP;
  std::vector<float4> rows;
  for (std::size_t sample = 0; sample < PHOTON_MAP_SAMPLES; ++sample) {
    const std::size_t first = drawn.size() * sample / PHOTON_MAP_SAMPLES,
                      last = drawn.size() * (sample + 1) / PHOTON_MAP_SAMPLES;
    const std::span<Beam> own = std::span(drawn).subspan(first, last - first);
    sort_beams(own, reach > 0 ? reach : 1);
    for (std::size_t i = 0; i < own.size(); i += BEAM_GROUP)
      append_group(own.subspan(i, std::min<std::size_t>(BEAM_GROUP, own.size() - i)), radius, rows);
    rows.resize((sample + 1) * groups * BEAM_GROUP_ROWS);
  }
  return rows;
}

}  // namespace sundog
