// See local_origin.h.
#include "compile/local_origin.h"

#include <cmath>

namespace sundog {
namespace {

constexpr double far_lengths = 2;

/// `value` to a multiple of `step`; 0 where that is no number.
double rounded_to(double value, double step) {
  const double multiple = std::round(value / step) * step;
  return std::isfinite(multiple) ? multiple : 0;
}

/// The length of the view, to a power of two below it; 0 where there is none.
double view_step(double length) {
  return length > 0 && std::isfinite(length) ? std::ldexp(1.0, std::ilogb(length)) : 0;
}

}  // namespace

dvec3 local_origin(const Camera& camera) {
  const double length = glm::length(camera.target - camera.position), step = view_step(length) / 2;
  dvec3 origin(0);
  for (int axis = 0; axis < 3; ++axis)
    if (step > 0 && std::abs(camera.target[axis]) > far_lengths * length)
      origin[axis] = rounded_to(camera.target[axis], step);
  return origin;
}

double far_part(double offset, double period, const Camera& camera) {
  const double length = glm::length(camera.target - camera.position), step = view_step(length) / 2;
  if (!(step > 0) || !(std::abs(offset) > far_lengths * length)) return 0;
  return rounded_to(offset, period > 0 ? period : step);
}

SplitPoint split_point(const dvec3& v) {
  SplitPoint parts{};
  const glm::vec3 high(v), low(v - dvec3(high));
  parts.high = {high.x, high.y, high.z, 0};
  parts.low = {low.x, low.y, low.z, 0};
  return parts;
}

}  // namespace sundog
