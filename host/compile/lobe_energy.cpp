// See lobe_energy.h.
#include "compile/lobe_energy.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <numbers>

#include "shared/lobe_energy.h"

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

constexpr int steps = 24;

double cosine_of(u32 column) { return std::max(double(column) / (LOBE_STEPS - 1), 0.01); }

/// Light that comes from the cosine `from` and the part of it that is sent on.
struct Sent {
  double from, part;
};

/// A white lobe's light by visible normals, each with the same weight.
std::vector<Sent> sent_to(double cosine, double alpha) {
  const dvec3 wo(std::sqrt(1 - cosine * cosine), 0, cosine);
  const double lambda_o = smith_lambda(cosine, alpha);
  std::vector<Sent> sent;
  for (int i = 0; i < steps; ++i)
    for (int j = 0; j < steps; ++j) {
      const dvec3 h = visible_normal(wo, alpha, (i + 0.5) / steps, (j + 0.5) / steps);
      const double out = (2 * glm::dot(wo, h) * h - wo).z;
      if (out > 0) sent.push_back({out, (1 + lambda_o) / (1 + lambda_o + smith_lambda(out, alpha))});
    }
  return sent;
}

double energy(double cosine, double alpha) {
  double sum = 0;
  for (const Sent& one : sent_to(cosine, alpha)) sum += one.part;
  return sum / (steps * steps);
}

using Row = std::array<double, LOBE_STEPS>;

double gain_at(const Row& gains, double cosine) {
  const double x = cosine * (LOBE_STEPS - 1);
  const auto left = std::min(static_cast<std::size_t>(x), std::size_t{LOBE_STEPS - 2});
  return std::lerp(gains[left], gains[left + 1], x - double(left));
}

Row gains_of(double alpha) {
  std::array<std::vector<Sent>, LOBE_STEPS> sent;
  for (u32 column = 0; column < LOBE_STEPS; ++column) sent[column] = sent_to(cosine_of(column), alpha);
  Row gains;
  gains.fill(1);
  for (int round = 0; round < 12; ++round) {
    Row next;
    for (u32 column = 0; column < LOBE_STEPS; ++column) {
      double sum = 0;
      for (const Sent& one : sent[column]) sum += one.part * gain_at(gains, one.from);
      next[column] = std::sqrt(gains[column] * (steps * steps) / sum);
    }
    gains = next;
  }
  return gains;
}

void add_gains(std::vector<float>& table) {
  const auto alpha_of = [](u32 row) { return double(row) / (LOBE_STEPS - 1); };
  table.resize(2 * table.size());
  tbb::parallel_for(0u, LOBE_STEPS, [&](u32 row) {
    const Row of_row = gains_of(alpha_of(row));
    std::copy(of_row.begin(), of_row.end(),
              table.begin() + static_cast<std::ptrdiff_t>(LOBE_GAINS + row * LOBE_STEPS));
  });
}

// Of dielectrics: the numbers of a facet along an axis.
constexpr int glass_draws = 20;

/// Fresnel's reflectance at the cosine c; eta: the index behind over that before. `bent`: the cosine behind.
double reflectance(double c, double eta, double& bent) {
  const double square = 1 - (1 - c * c) / (eta * eta);
  bent = square > 0 ? std::sqrt(square) : 0;
  if (square <= 0) return 1;
  const double s = (c - eta * bent) / (c + eta * bent), p = (eta * c - bent) / (eta * c + bent);
  return (s * s + p * p) / 2;
}

/// The part of light that a white interface's facets reflect or transmit to a viewer without a second
/// meeting.
double glass_energy(double cosine, double alpha, double eta) {
  const dvec3 wo(std::sqrt(1 - cosine * cosine), 0, cosine);
  const double seen = 1 + smith_lambda(cosine, alpha);
  double sum = 0;
  for (int i = 0; i < glass_draws; ++i)
    for (int j = 0; j < glass_draws; ++j) {
      const dvec3 h = visible_normal(wo, alpha, (i + 0.5) / glass_draws, (j + 0.5) / glass_draws);
      const double c = std::clamp(glm::dot(wo, h), 0.0, 1.0);
      double bent = 0;
      const double f = reflectance(c, eta, bent);
      const double out = (2 * c * h - wo).z, through = ((c / eta - bent) * h - wo / eta).z;
      if (out > 0) sum += f * seen / (seen + smith_lambda(out, alpha));
      if (f < 1 && through < 0) sum += (1 - f) * seen / (seen + smith_lambda(through, alpha));
    }
  return sum / (glass_draws * glass_draws);
}

/// The mean over directions, by their cosine, of 1 minus values at even cosines.
double mean_lost(const float* values) {
  double sum = 0;
  for (u32 i = 0; i + 1 < GLASS_STEPS; ++i) {
    const double a = double(i) / (GLASS_STEPS - 1), b = double(i + 1) / (GLASS_STEPS - 1);
    sum += (b - a) * ((1 - double(values[i])) * (2 * a + b) + (1 - double(values[i + 1])) * (a + 2 * b)) / 6;
  }
  return std::max(2 * sum, 0.0);
}

/// The part of even light that enters the thicker medium.
double mean_entering(double eta) {
  double sum = 0, bent = 0;
  for (int i = 0; i < 256; ++i) {
    const double c = (i + 0.5) / 256;
    sum += 2 * c * (1 - reflectance(c, eta, bent));
  }
  return sum / 256;
}

/// What is lost at the first meeting with a facet, in the mean, and where it goes.
void add_further(std::vector<float>& table) {
  table.resize(GLASS_LOST + GLASS_INDICES * 2 * GLASS_STEPS);
  for (u32 i = 0; i < GLASS_INDICES * 2 * GLASS_STEPS; ++i)
    table[GLASS_LOST + i] = static_cast<float>(mean_lost(table.data() + LOBE_GLASS + i * GLASS_STEPS));
  for (u32 i = 0; i < GLASS_INDICES * GLASS_STEPS; ++i) {
    const u32 index = i / GLASS_STEPS;
    const double less = std::max(double(GLASS_REACH) * index / (GLASS_INDICES - 1), 1e-3);
    table[GLASS_THROUGH + i] = static_cast<float>(mean_entering(1 / (1 - less)));
  }
}

void add_glass(std::vector<float>& table) {
  table.resize(LOBE_GLASS + GLASS_INDICES * 2 * GLASS_STEPS * GLASS_STEPS);
  tbb::parallel_for(0u, GLASS_INDICES * 2 * GLASS_STEPS, [&](u32 i) {
    const u32 index = i / (2 * GLASS_STEPS), side = i / GLASS_STEPS % 2, row = i % GLASS_STEPS;
    // Interfaces between equal indices are none: what is nearly so is computed a little beside.
    const double less = std::max(double(GLASS_REACH) * index / (GLASS_INDICES - 1), 1e-3);
    const double eta = side == 0 ? 1 / (1 - less) : 1 - less;
    for (u32 column = 0; column < GLASS_STEPS; ++column) {
      const double cosine = std::max(double(column) / (GLASS_STEPS - 1), 0.01);
      table[LOBE_GLASS + i * GLASS_STEPS + column] =
          static_cast<float>(glass_energy(cosine, double(row) / (GLASS_STEPS - 1), eta));
    }
  });
}

}  // namespace

std::vector<float> make_lobe_energy(LobeTables wanted) {
  std::vector<float> table;
  const auto alpha_of = [](u32 row) { return double(row) / (LOBE_STEPS - 1); };
  for (u32 row = 0; row < LOBE_STEPS; ++row)
    for (u32 column = 0; column < LOBE_STEPS; ++column)
      table.push_back(static_cast<float>(energy(cosine_of(column), alpha_of(row))));
  if (wanted.gains) add_gains(table);
  if (wanted.glass) {
    add_glass(table);
    add_further(table);
  }
  return table;
}

}  // namespace sundog
