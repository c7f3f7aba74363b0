// The irradiance of area lights, in closed form.
#pragma once
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>
#include <vector>

#include "scene/lamps.h"

/// Lambert's irradiance at p of a polygon of radiance 1 that lies above the surface of normal n.
inline double polygon_irradiance(const std::vector<glm::dvec3>& corners, const glm::dvec3& p,
                                 const glm::dvec3& n) {
  double sum = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec3 a = glm::normalize(corners[i] - p),
                     b = glm::normalize(corners[(i + 1) % corners.size()] - p);
    const glm::dvec3 across = glm::cross(a, b);
    const double sine = glm::length(across);
    if (sine > 0) sum += std::atan2(sine, glm::dot(a, b)) * glm::dot(across / sine, n);
  }
  return std::abs(sum) / 2;
}

/// The rectangle's corners, or those of a polygon that is all but the disk.
inline std::vector<glm::dvec3> corners_of(const sundog::LightDescription& light) {
  const sundog::LampAxes axes = sundog::lamp_axes(light);
  std::vector<glm::dvec3> corners;
  if (light.type == sundog::LightType::rectangle) {
    for (const auto& [a, b] : {std::pair{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}})
      corners.push_back(light.position + a * axes.u + b * axes.v);
    return corners;
  }
  constexpr int count = 4096;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * std::numbers::pi * i / count;
    corners.push_back(light.position + std::cos(angle) * axes.u + std::sin(angle) * axes.v);
  }
  return corners;
}

inline double sphere_irradiance(const sundog::LightDescription& light, const glm::dvec3& p,
                                const glm::dvec3& n) {
  const glm::dvec3 to = light.position - p;
  const double d = glm::length(to);
  return std::numbers::pi * light.radius * light.radius / (d * d) * glm::dot(n, to / d);
}

inline double irradiance(const sundog::LightDescription& light, const glm::dvec3& p, const glm::dvec3& n) {
  switch (light.type) {
    case sundog::LightType::rectangle:
    case sundog::LightType::disk:
      return polygon_irradiance(corners_of(light), p, n);
    case sundog::LightType::sphere:
      return sphere_irradiance(light, p, n);
    case sundog::LightType::ambient:
    case sundog::LightType::directional:
    case sundog::LightType::point:
    case sundog::LightType::spot:
      break;
  }
  throw std::logic_error("a light without an extent");
}
