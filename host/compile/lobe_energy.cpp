// See lobe_energy.h.
#include "compile/lobe_energy.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <numbers>

#include "shared/scene.h"

namespace sundog {
namespace {

using glm::dvec3;

double smith_lambda(double cosine, double alpha) {
  const double square = std::max(cosine * cosine, 1e-12);
  return (std::sqrt(1 + alpha * alpha * (1 - square) / square) - 1) / 2;
}

/// As kernels/lib/shade/rough.cl has it, about +z, for a viewer in the plane y = 0.
dvec3 visible_normal(const dvec3& wo, double alpha, double u, double v) {
  const dvec3 stretched = glm::normalize(dvec3(alpha * wo.x, 0, wo.z));
  const double z = (1 - v) * (1 + stretched.z) - stretched.z, angle = 2 * std::numbers::pi * u;
  const double side = std::sqrt(std::max(1 - z * z, 0.0));
  const dvec3 h = dvec3(side * std::cos(angle), side * std::sin(angle), z) + stretched;
  return glm::normalize(dvec3(alpha * h.x, alpha * h.y, std::max(h.z, 1e-6)));
}

double energy(double cosine, double alpha) {
  constexpr int steps = 24;
  const dvec3 wo(std::sqrt(1 - cosine * cosine), 0, cosine);
  const double lambda_o = smith_lambda(cosine, alpha);
  double sum = 0;
  for (int i = 0; i < steps; ++i)
    for (int j = 0; j < steps; ++j) {
      const dvec3 h = visible_normal(wo, alpha, (i + 0.5) / steps, (j + 0.5) / steps);
      const double out = (2 * glm::dot(wo, h) * h - wo).z;
      if (out > 0) sum += (1 + lambda_o) / (1 + lambda_o + smith_lambda(out, alpha));
    }
  return sum / (steps * steps);
}

}  // namespace

std::vector<float> make_lobe_energy() {
  std::vector<float> table;
  for (u32 row = 0; row < LOBE_STEPS; ++row)
    for (u32 column = 0; column < LOBE_STEPS; ++column)
      table.push_back(static_cast<float>(
          energy(std::max(double(column) / (LOBE_STEPS - 1), 0.01), double(row) / (LOBE_STEPS - 1))));
  return table;
}

}  // namespace sundog
