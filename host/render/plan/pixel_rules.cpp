// Divides colour differences by the fourth root of light; compares object, material, albedo and normal.
#include "render/plan/pixel_rules.h"

#include <algorithm>
#include <cmath>

namespace sundog {

Color color_at(const Film& film, std::size_t pixel) { return mean_of(film.sums[pixel], film.weights[pixel]); }

float contrast(const Color& a, const Color& b) {
  const float light = std::max(seen_light(a), seen_light(b));
  return (std::abs(a.r - b.r) + std::abs(a.g - b.g) + std::abs(a.b - b.b)) / std::sqrt(std::sqrt(light));
}

bool same_surface(const Film& film, std::size_t a, std::size_t b, float least_cosine) {
  const std::size_t vectors = film.layout.vectors();
  const float4 *of_a = &film.aovs[vectors * a], *of_b = &film.aovs[vectors * b];
  if (of_a[1].w != of_b[1].w || of_a[2].w != of_b[2].w) return false;
  if (of_a[1].w < 0) return true;  // both see the background
  constexpr float same_albedo = 0.02f;
  const float4 &x = of_a[2], &y = of_b[2];
  if (std::abs(x.x - y.x) + std::abs(x.y - y.y) + std::abs(x.z - y.z) > same_albedo) return false;
  return of_a[0].x * of_b[0].x + of_a[0].y * of_b[0].y + of_a[0].z * of_b[0].z >= least_cosine;
}

}  // namespace sundog
