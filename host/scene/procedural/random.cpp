// Hashes with SplitMix64 and interpolates gradients of a lattice (Perlin 2002). Has its own length(), because
// glm's instructions may differ between builds.
#include "scene/procedural/random.h"

#include <cmath>

namespace sundog::procedural {

namespace {

// The finaliser of SplitMix64 (Steele, Lea and Flood 2014).
std::uint64_t scrambled(std::uint64_t x) {
  x += 0x9E3779B97F4A7C15ull;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ull;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBull;
  return x ^ (x >> 31);
}

double fade(double t) { return t * t * t * (t * (t * 6.0 - 15.0) + 10.0); }
double mix(double a, double b, double t) { return a + (b - a) * t; }

double dot3(const glm::dvec3& a, const glm::dvec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

// The gradient at a lattice point, in the cube [-1, 1]^3.
glm::dvec3 lattice_slope(std::uint64_t seed, std::int64_t x, std::int64_t y, std::int64_t z) {
  std::uint64_t h = scrambled(seed + static_cast<std::uint64_t>(x));
  h = scrambled(h + static_cast<std::uint64_t>(y));
  h = scrambled(h + static_cast<std::uint64_t>(z));
  constexpr double scale = 1.0 / 1048576.0;  // 21 bits per axis
  const auto part = [&](int shift) { return static_cast<double>((h >> shift) & 0x1FFFFFu) * scale - 1.0; };
  return {part(0), part(21), part(42)};
}

}  // namespace

double uniform(std::uint64_t seed, std::uint64_t index) {
  return static_cast<double>(scrambled(scrambled(seed) + index) >> 11) * (1.0 / 9007199254740992.0);
}

double length(const glm::dvec3& v) { return std::sqrt(dot3(v, v)); }

glm::dvec3 normalized(const glm::dvec3& v) {
  const double l = length(v);
  return {v.x / l, v.y / l, v.z / l};
}

glm::dvec3 Sequence::direction() {
  // Rejection sampling in the cube, because trigonometric functions differ in the last bits between C
  // libraries.
  for (;;) {
    const double x = between(-1, 1), y = between(-1, 1), z = between(-1, 1);
    const double squared = x * x + y * y + z * z;
    if (squared > 0.01 && squared < 1) return normalized({x, y, z});
  }
}

double gradient_noise(std::uint64_t seed, const glm::dvec3& point) {
  const double fx = std::floor(point.x), fy = std::floor(point.y), fz = std::floor(point.z);
  const auto ix = static_cast<std::int64_t>(fx), iy = static_cast<std::int64_t>(fy),
             iz = static_cast<std::int64_t>(fz);
  const double x = point.x - fx, y = point.y - fy, z = point.z - fz;
  double corner[8];
  for (int i = 0; i < 8; i++) {
    const int a = i & 1, b = (i >> 1) & 1, c = i >> 2;
    corner[i] = dot3(lattice_slope(seed, ix + a, iy + b, iz + c), {x - a, y - b, z - c});
  }
  const double u = fade(x), v = fade(y), w = fade(z);
  const double low = mix(mix(corner[0], corner[1], u), mix(corner[2], corner[3], u), v);
  const double high = mix(mix(corner[4], corner[5], u), mix(corner[6], corner[7], u), v);
  return mix(low, high, w);
}

}  // namespace sundog::procedural
