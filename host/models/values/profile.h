// Profiles of surfaces of revolution: cubics in the half plane of radius (x) and height (y).
#pragma once
#include <glm/glm.hpp>
#include <vector>

namespace sundog {

/// A cubic by its control points (Bézier), from a to d.
struct ProfileCubic {
  glm::dvec2 a{0}, b{0}, c{0}, d{0};

  glm::dvec2 at(double t) const;
  glm::dvec2 slope(double t) const;
  glm::dvec2 bend(double t) const;  // the second derivative
  ProfileCubic reversed() const { return {d, c, b, a}; }
};

/// Cuts the cubic into parts on which both coordinates and their derivatives are monotone; adjacent ends are
/// equal.
std::vector<ProfileCubic> monotone_parts(const ProfileCubic& cubic);

}  // namespace sundog
