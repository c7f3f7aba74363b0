// Cuts a box with planes and balls, combines their inverse distances along a direction by a p-norm, and adds
// ripples of noise.
#include "scene/procedural/soft_solid.h"

#include <algorithm>
#include <cmath>

#include "scene/procedural/random.h"

namespace sundog::procedural {

namespace {

using glm::dvec3;

double dot(const dvec3& a, const dvec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

// Adds the six sides, each slightly tilted and moved inwards by up to a twelfth.
void add_sides(SoftSolid& solid, const dvec3& half, double tilt, Sequence& random) {
  for (int axis = 0; axis < 3; axis++) {
    for (const double side : {-1.0, 1.0}) {
      dvec3 normal{random.between(-tilt, tilt), random.between(-tilt, tilt), random.between(-tilt, tilt)};
      normal[axis] = side;
      solid.cuts.push_back({normalized(normal), half[axis] * random.between(11.0 / 12, 1)});
    }
  }
}

// The support function of the box in a direction.
double box_reach(const dvec3& half, const dvec3& direction) {
  return std::abs(direction.x) * half.x + std::abs(direction.y) * half.y + std::abs(direction.z) * half.z;
}

// Cuts off edges and corners; skips planes along an axis, which would only shrink the block.
void add_chips(SoftSolid& solid, const dvec3& half, int count, Sequence& random) {
  for (int made = 0; made < count;) {
    const dvec3 normal = random.direction();
    const double share = random.between(0.78, 0.97);
    const dvec3 size{std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)};
    const double middle = std::max(std::min(size.x, size.y), std::min(std::max(size.x, size.y), size.z));
    if (middle < 0.35) continue;
    solid.cuts.push_back({normal, share * box_reach(half, normal)});
    made++;
  }
}

// The distance to the nearest plane along a direction.
double innermost(const SoftSolid& solid, const dvec3& direction) {
  double inverse = 0;
  for (const Cut& cut : solid.cuts) inverse = std::max(inverse, dot(cut.normal, direction) / cut.distance);
  return 1 / inverse;
}

// Adds balls outside the block that dip into it by a few hundredths, as if two cubes had broken apart there.
void add_dents(SoftSolid& solid, int count, Sequence& random) {
  for (int i = 0; i < count; i++) {
    const dvec3 direction = random.direction();
    const double end = innermost(solid, direction);
    const double radius = end * random.between(0.8, 2.2);
    const double depth = end * random.between(0.02, 0.07);
    solid.scoops.push_back({direction * (end - depth + radius), radius});
  }
}

// The distance along a unit direction to the near side of the ball; 0 if it is missed.
double scoop_distance(const Scoop& scoop, const dvec3& direction) {
  const double along = dot(scoop.center, direction);
  const double under = along * along - dot(scoop.center, scoop.center) + scoop.radius * scoop.radius;
  return along > 0 && under > 0 ? along - std::sqrt(under) : 0;
}

double ripples(const SoftSolid& solid, const dvec3& point) {
  const dvec3 p = point / solid.feature_size;
  return 0.7 * gradient_noise(solid.seed, p) + 0.25 * gradient_noise(solid.seed + 1, p * 2.3) +
         0.05 * gradient_noise(solid.seed + 2, p * 6.1);
}

}  // namespace

SoftSolid make_soft_solid(const IceSurface& surface, std::uint64_t seed) {
  SoftSolid solid;
  Sequence random(seed);
  const dvec3 half = surface.size * 0.5;
  add_sides(solid, half, surface.tilt, random);
  add_chips(solid, half, surface.chips, random);
  const double smallest = std::min({half.x, half.y, half.z});
  for (Cut& cut : solid.cuts) {
    cut.distance += dot(cut.normal, surface.offset);
    if (cut.distance < 0.1 * smallest)
      throw GenerateError(
          "offset: wanted the block's origin well inside this surface; make offset smaller or size larger");
  }
  add_dents(solid, surface.dents, random);
  solid.doublings = 6 - surface.softness;
  solid.roughness = surface.roughness;
  solid.feature_size = 0.8 * smallest;
  solid.seed = seed;
  return solid;
}

double surface_distance(const SoftSolid& solid, const dvec3& direction) {
  std::vector<double> inverse;
  inverse.reserve(solid.cuts.size() + solid.scoops.size());
  for (const Cut& cut : solid.cuts)
    inverse.push_back(std::max(0.0, dot(cut.normal, direction) / cut.distance));
  for (const Scoop& scoop : solid.scoops) {
    const double distance = scoop_distance(scoop, direction);
    inverse.push_back(distance > 0 ? 1 / distance : 0);
  }
  const double greatest = *std::max_element(inverse.begin(), inverse.end());
  double sum = 0;
  for (const double g : inverse) {
    double power = g / greatest;
    for (int i = 0; i < solid.doublings; i++) power *= power;
    sum += power;
  }
  for (int i = 0; i < solid.doublings; i++) sum = std::sqrt(sum);
  const double distance = 1 / (greatest * sum);
  return distance * (1 + solid.roughness * ripples(solid, direction * distance));
}

}  // namespace sundog::procedural
