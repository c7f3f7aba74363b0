// Rounds a far target to steps of a quarter to half of the view's length, then prefers an object's or light's
// position nearby that leaves fewer decimals.
#include "compile/view/local_origin.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>
#include <vector>

#include "scene/kinds.h"

namespace sundog {
namespace {

constexpr double far_lengths = 2;
constexpr std::size_t most_places = 64;
constexpr int least_decimals = -6, most_decimals = 8;
constexpr double rounding = 0x1p-50;  // of sums of a few doubles

/// `value` rounded to a multiple of `step`; 0 if that is not finite.
double rounded_to(double value, double step) {
  const double multiple = std::round(value / step) * step;
  return std::isfinite(multiple) ? multiple : 0;
}

/// The view's length, rounded down to a power of two; 0 if it has none.
double view_step(double length) {
  return length > 0 && std::isfinite(length) ? std::ldexp(1.0, std::ilogb(length)) : 0;
}

/// Positions along an axis of the camera, the lights and the first objects.
std::vector<double> places_along(const SceneDescription& scene, int axis) {
  std::vector<double> places{scene.camera.target[axis], scene.camera.position[axis]};
  for (const LightDescription& light : scene.lights)
    if (places.size() < most_places && facts_of(light.type).placed) places.push_back(light.position[axis]);
  for (const Object& object : scene.objects)
    if (places.size() < most_places) places.push_back(object.world_from_object[3][axis]);
  return places;
}

/// Decimals of a number known to `error`; negative: trailing zeros before the point.
int decimals(double value, double error) {
  for (int count = least_decimals; count < most_decimals; ++count)
    if (const double unit = std::pow(10.0, -count);
        std::abs(value - std::round(value / unit) * unit) <= error)
      return count;
  return most_decimals;
}

/// How badly an origin suits the positions: total decimals, positions not at the origin, distance of the
/// target. The origin itself counts at least `least` decimals, so a round number is no advantage.
std::tuple<int, std::size_t, double> unfitness(double origin, double target,
                                               const std::vector<double>& places, int least) {
  int sum = std::max(least, decimals(origin, rounding * std::abs(origin)));
  std::size_t others = 0;
  double last = std::numeric_limits<double>::quiet_NaN();
  for (const double place : places) {  // coincident places count once
    others += place != origin;
    if (place != std::exchange(last, place))
      sum += std::max(0, decimals(place - origin, rounding * std::max(std::abs(place), std::abs(origin))));
  }
  return {sum, others, std::abs(origin - target)};
}

/// `origin`, or a position near the target that suits the others better.
double rounder_origin(double origin, double target, double reach, std::vector<double> places) {
  std::ranges::sort(places);
  auto best = unfitness(origin, target, places, least_decimals);
  double last = origin;
  for (const double place : places) {
    if (std::abs(place - target) > reach || place == std::exchange(last, place)) continue;
    const auto found = unfitness(place, target, places, 0);
    if (found < best) std::tie(best, origin) = std::tie(found, place);
  }
  return origin;
}

}  // namespace

dvec3 local_origin(const SceneDescription& scene) {
  const Camera& camera = scene.camera;
  const double length = glm::length(camera.target - camera.position), step = view_step(length) / 2;
  dvec3 origin(0);
  for (int axis = 0; axis < 3; ++axis)
    if (step > 0 && std::abs(camera.target[axis]) > far_lengths * length)
      origin[axis] = rounder_origin(rounded_to(camera.target[axis], step), camera.target[axis],
                                    far_lengths * length, places_along(scene, axis));
  return origin;
}

double far_part(double offset, double period, const Camera& camera) {
  const double length = glm::length(camera.target - camera.position), step = view_step(length) / 2;
  if (!(step > 0) || !(std::abs(offset) > far_lengths * length)) return 0;
  return rounded_to(offset, period > 0 ? period : step);
}

SplitPoint split_point(const dvec3& v) {
  // Componentwise, because GCC 12 converts whole vectors to float and back in vain.
  const auto high = [](double value) { return static_cast<float>(value); };
  const auto low = [&](double value) { return static_cast<float>(value - double(high(value))); };
  return {{high(v.x), high(v.y), high(v.z), 0}, {low(v.x), low(v.y), low(v.z), 0}};
}

}  // namespace sundog
