// Plane curves of lines with rounded corners or of splines: profiles of lathes, outlines of extrusions.
#pragma once
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "models/values/profile.h"

namespace sundog::procedural {

struct ProfilePoint {
  glm::dvec2 at;
  double rounding = 0;  // radius of the arc that replaces the corner between lines
};

enum class ProfileCurve { lines, spline };

/// A short straight step of a curve, with the curve's unit normals at its ends, to the right of its
/// direction.
struct ProfileStep {
  glm::dvec2 a, b, normal_a, normal_b;
};
using Profile = std::vector<ProfileStep>;
inline constexpr std::size_t most_steps = 16384;

/// Cosine and sine of `share` of a turn, with the same bits on every machine.
glm::dvec2 turn_by(double share);

/// The curve through the points, in steps that turn by at most the angle whose cosine is `cos_turn`. The
/// spline is a centripetal Catmull-Rom curve (Yuksel et al. 2011, "Parameterization and Applications of
/// Catmull-Rom Curves"); a point given twice is a corner, and a curve that ends on the line x = 0 continues
/// as its mirror image. A curve whose last point is its first is closed. Throws GenerateError for fewer than
/// two different points, a rounding in a spline, a rounding for which the lines beside it are too short, and
/// more than `most_steps`.
Profile follow(std::span<const ProfilePoint> points, ProfileCurve curve, double cos_turn);

/// follow()'s curve as cubics, which deviate from an arc by less than 1e-7 of its radius. Throws
/// GenerateError like follow(), except for too many steps.
std::vector<ProfileCubic> follow_exactly(std::span<const ProfilePoint> points, ProfileCurve curve);

/// The curve in the opposite direction.
Profile reversed(const Profile& profile);

/// The area on the left of a curve, closed by a straight line: positive if it runs counterclockwise.
double area_of(const Profile& profile);

/// A point near which a curve crosses itself; nothing if it does not.
std::optional<glm::dvec2> crossing_of(const Profile& profile);

/// Throws GenerateError, with the place, if the curve crosses itself.
void check_crossings(const Profile& profile);

}  // namespace sundog::procedural
