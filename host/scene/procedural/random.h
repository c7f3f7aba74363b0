// Seeded numbers and smooth noise from integer hashes and + - * / sqrt only, so that bits are the same on
// every machine.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>

namespace sundog::procedural {

/// A number in [0, 1) for (seed, index); neighbouring indices are unrelated.
double uniform(std::uint64_t seed, std::uint64_t index);

/// Successive numbers from one seed.
class Sequence {
 public:
  explicit Sequence(std::uint64_t seed) : seed_(seed) {}
  double next() { return uniform(seed_, index_++); }
  double between(double lower, double upper) { return lower + (upper - lower) * next(); }
  /// A direction uniform over the unit sphere.
  glm::dvec3 direction();

 private:
  std::uint64_t seed_, index_ = 0;
};

/// Gradient noise (Perlin 1985, with the quintic fade of Perlin 2002) in [-1, 1]; features are about 1 apart.
double gradient_noise(std::uint64_t seed, const glm::dvec3& point);

double length(const glm::dvec3& v);
glm::dvec3 normalized(const glm::dvec3& v);

}  // namespace sundog::procedural
