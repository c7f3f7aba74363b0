// Lists sufficiently flat triangles with their cumulative areas; draws a place in each equal share of the
// area, then its turn, size and object.
#include "scene/procedural/scatter.h"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "scene/procedural/random.h"

namespace sundog {
namespace {

using glm::dmat4;
using glm::dvec3;

/// A triangle as a corner and two edges, and the total area up to and including it.
struct Part {
  dvec3 corner, u, v, normal;
  double end = 0;
};

std::vector<Part> parts_of(const Scatter& how, std::span<const Ground> grounds) {
  const double least = std::cos(glm::radians(how.steepest)) - 1e-9;
  std::vector<Part> parts;
  double area = 0;
  for (const Ground& ground : grounds)
    for (const glm::uvec3& corners : ground.mesh.triangles) {
      const auto at = [&](unsigned i) {
        return dvec3(ground.place * glm::dvec4(dvec3(ground.mesh.positions[i]), 1));
      };
      Part part{at(corners.x), {}, {}, {}};
      part.u = at(corners.y) - part.corner, part.v = at(corners.z) - part.corner;
      const dvec3 across = glm::cross(part.u, part.v);
      const double twice = glm::length(across);
      if (!(twice > 0) || !std::isfinite(twice)) continue;
      part.normal = across / twice;
      if (part.normal.y < least) continue;
      part.end = area += twice / 2;
      parts.push_back(part);
    }
  return parts;
}

/// The shortest rotation from +y to a unit vector.
dmat4 tilt(const dvec3& axis) {
  const dvec3 up(0, 1, 0), about = glm::cross(up, axis);
  const double sine = glm::length(about);
  if (sine < 1e-12) return axis.y > 0 ? dmat4(1) : glm::rotate(dmat4(1), glm::radians(180.0), dvec3(1, 0, 0));
  return glm::rotate(dmat4(1), std::atan2(sine, axis.y), about / sine);
}

}  // namespace

std::vector<ScatteredPlace> scatter(const Scatter& how, std::span<const Ground> grounds, std::size_t limit,
                                    double& wanted) {
  const std::vector<Part> parts = parts_of(how, grounds);
  const double area = parts.empty() ? 0 : parts.back().end;
  procedural::Sequence random(how.seed);
  wanted = std::floor(how.density * area + random.next());
  std::vector<ScatteredPlace> places;
  if (!(wanted <= static_cast<double>(limit))) return places;
  const auto count = static_cast<std::size_t>(wanted);
  for (std::size_t i = 0; i < count; ++i) {
    const double at = (static_cast<double>(i) + random.next()) / wanted * area;
    const auto found = std::ranges::upper_bound(parts, at, {}, &Part::end);
    const Part& part = found == parts.end() ? parts.back() : *found;
    const double root = std::sqrt(random.next()), other = random.next();
    const dvec3 p = part.corner + part.u * (root * (1 - other)) + part.v * (root * other);
    dmat4 place = glm::translate(dmat4(1), p) * (how.upright ? dmat4(1) : tilt(part.normal));
    place = glm::rotate(place, glm::radians(how.turn * random.next()), dvec3(0, 1, 0));
    place = glm::scale(place, dvec3(random.between(how.scale.x, how.scale.y)));
    places.push_back({place, random.next()});
  }
  return places;
}

}  // namespace sundog
