// Curves in a plane, of lines with rounded corners or of a spline: profiles of lathes, outlines of
// extrusions.
#pragma once
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "models/values/profile.h"

namespace sundog::procedural {

struct ProfilePoint {
  glm::dvec2 at;
  double rounding = 0;  // radius of the arc that replaces a corner between lines
};

enum class ProfileCurve { lines, spline };

/// A short line of a curve, with the curve's unit normals at its ends, to the right of its direction.
struct ProfileStep {
  glm::dvec2 a, b, normal_a, normal_b;
};
using Profile = std::vector<ProfileStep>;
inline constexpr std::size_t most_steps = 16384;

/// Cosine and sine of `share` of a turn, with the same bits on every machine.
glm::dvec2 turn_by(double share);

/// The curve through the points, in steps that turn by at most the angle of `cos_turn`. The spline is a
/// centripetal Catmull-Rom curve (Yuksel and others 2011, "Parameterization and Applications of Catmull-Rom
/// Curves"); a point given twice is a corner of it, and the line x = 0 mirrors what ends on it. A curve whose
/// last point is its first is closed. Throws GenerateError for fewer than two places, a rounding of a spline,
/// one that the lines beside it have no room for, and more than `most_steps`.
Profile follow(std::span<const ProfilePoint> points, ProfileCurve curve, double cos_turn);

/// follow()'s curve as cubics. Those of an arc differ from it by less than 1e-7 of its radius. Throws like
/// follow().
std::vector<ProfileCubic> follow_exactly(std::span<const ProfilePoint> points, ProfileCurve curve);

/// The curve, from its last point to its first.
Profile reversed(const Profile& profile);

/// The area on the left of a curve, closed by a straight line: positive if it runs counterclockwise.
double area_of(const Profile& profile);

/// Where a curve crosses itself.
std::optional<glm::dvec2> crossing_of(const Profile& profile);

/// Throws GenerateError, with the place, if the curve crosses itself.
void check_crossings(const Profile& profile);

}  // namespace sundog::procedural
