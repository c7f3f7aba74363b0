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
  // One by one: of whole vectors GCC 12 takes the way to float and back for nothing.
  const auto high = [](double value) { return static_cast<float>(value); };
  const auto low = [&](double value) { return static_cast<float>(value - double(high(value))); };
  return {{high(v.x), high(v.y), high(v.z), 0}, {low(v.x), low(v.y), low(v.z), 0}};
}

}  // namespace sundog
