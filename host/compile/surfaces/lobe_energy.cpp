// Averages over visible facets from a Fibonacci lattice, scales gains in 12 rounds, and keeps white lobes
// slightly dark so that none exceeds 1.
#include "compile/surfaces/lobe_energy.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>

#include "compile/view/lattice_turns.h"
#include "shared/lobe_energy.h"

namespace sundog {
namespace {

using glm::dvec3;

double smith_lambda(double cosine, double alpha) {
  const double square = std::max(cosine * cosine, 1e-12);
  return (std::sqrt(1 + alpha * alpha * (1 - square) / square) - 1) / 2;
}

// A Fibonacci lattice is also even along the sum of its axes, so the limit of transmission cuts off no whole
// row.
constexpr int draws = 377, lattice_turn = 233;

// Energy that white lobes may lose, so that none exceeds 1 between table entries.
constexpr double gain_margin = 0.0015, glass_margin = 0.005;

/// Facet normals about +z, sampled by their visible area for a viewer in the plane y = 0.
using Normals = std::array<dvec3, draws>;

/// As visible_normal() in kernels/plain/shade/facets.cl.
Normals visible_normals(const dvec3& wo, double alpha) {
  const auto& turns = lattice_turns<draws, lattice_turn>();
  const dvec3 stretched = glm::normalize(dvec3(alpha * wo.x, 0, wo.z));
  Normals normals;
  for (std::size_t i = 0; i < draws; ++i) {
    const double v = (double(i) + 0.5) / draws;
    const double z = (1 - v) * (1 + stretched.z) - stretched.z, side = std::sqrt(std::max(1 - z * z, 0.0));
    const dvec3 h = dvec3(side * turns[i].cosine, side * turns[i].sine, z) + stretched;
    normals[i] = glm::normalize(dvec3(alpha * h.x, alpha * h.y, std::max(h.z, 1e-6)));
  }
  return normals;
}

double alpha_of(u32 row, u32 rows) {
  const double root = double(row) / (rows - 1);
  return std::max(root * root, double(LEAST_LOBE_ALPHA));
}

double cosine_of(u32 column, u32 columns, double alpha) {
  return std::clamp(LOBE_COSINE(double(column) / (columns - 1), alpha), 1e-6, 1.0);
}

/// A position between columns of the tables, as kernels interpolate.
struct ColumnPlace {
  u32 left;
  double to_next;
};

ColumnPlace place_of(double cosine, double alpha, u32 columns) {
  const double x = LOBE_COLUMN(cosine, alpha) * (columns - 1);
  const u32 left = std::min(static_cast<u32>(x), columns - 2);
  return {left, x - left};
}

template <typename Row>
double in_row(const Row& row, const ColumnPlace& at) {
  return std::lerp(double(row[at.left]), double(row[at.left + 1]), at.to_next);
}

/// Light from a direction whose cosine is at `from`, and the fraction of it that is reflected.
struct Sent {
  ColumnPlace from;
  double part;
};

/// The light that a white lobe sends to a viewer, by equally weighted visible normals.
std::vector<Sent> sent_to(double cosine, double alpha) {
  const dvec3 wo(std::sqrt(1 - cosine * cosine), 0, cosine);
  const double lambda_o = smith_lambda(cosine, alpha);
  std::vector<Sent> sent;
  sent.reserve(draws);
  for (const dvec3& h : visible_normals(wo, alpha)) {
    const double out = (2 * glm::dot(wo, h) * h - wo).z;
    if (out > 0)
      sent.push_back(
          {place_of(out, alpha, LOBE_STEPS), (1 + lambda_o) / (1 + lambda_o + smith_lambda(out, alpha))});
  }
  return sent;
}

double energy(double cosine, double alpha) {
  double sum = 0;
  for (const Sent& one : sent_to(cosine, alpha)) sum += one.part;
  return sum / draws;
}

using Row = std::array<double, LOBE_STEPS>;

Row gains_of(double alpha) {
  std::array<std::vector<Sent>, LOBE_STEPS> sent;
  for (u32 column = 0; column < LOBE_STEPS; ++column)
    sent[column] = sent_to(cosine_of(column, LOBE_STEPS, alpha), alpha);
  Row gains;
  gains.fill(1);
  for (int round = 0; round < 12; ++round) {
    Row next;
    for (u32 column = 0; column < LOBE_STEPS; ++column) {
      double sum = 0;
      for (const Sent& one : sent[column]) sum += one.part * in_row(gains, one.from);
      next[column] = std::sqrt(gains[column] * draws / sum);
    }
    gains = next;
  }
  for (double& gain : gains) gain *= std::sqrt(1 - gain_margin);
  return gains;
}

void add_gains(std::vector<float>& table) {
  table.resize(2 * table.size());
  tbb::parallel_for(0u, LOBE_STEPS, [&](u32 row) {
    const Row of_row = gains_of(alpha_of(row, LOBE_STEPS));
    std::copy(of_row.begin(), of_row.end(),
              table.begin() + static_cast<std::ptrdiff_t>(LOBE_GAINS + row * LOBE_STEPS));
  });
}

/// Fresnel reflectance at the cosine c; eta: index behind over index before. `bent`: the cosine behind.
double reflectance(double c, double eta, double& bent) {
  const double square = 1 - (1 - c * c) / (eta * eta);
  bent = square > 0 ? std::sqrt(square) : 0;
  if (square <= 0) return 1;
  const double s = (c - eta * bent) / (c + eta * bent), p = (eta * c - bent) / (eta * c + bent);
  return (s * s + p * p) / 2;
}

/// The fraction of light that a white interface's facets reflect or transmit to a viewer by single
/// scattering.
double glass_energy(const dvec3& wo, const Normals& normals, double alpha, double eta) {
  const double seen = 1 + smith_lambda(wo.z, alpha);
  double sum = 0;
  for (const dvec3& h : normals) {
    const double c = std::clamp(glm::dot(wo, h), 0.0, 1.0);
    double bent = 0;
    const double f = reflectance(c, eta, bent);
    const double out = (2 * c * h - wo).z, through = ((c / eta - bent) * h - wo / eta).z;
    if (out > 0) sum += f * seen / (seen + smith_lambda(out, alpha));
    if (f < 1 && through < 0) sum += (1 - f) * seen / (seen + smith_lambda(through, alpha));
  }
  return sum / draws;
}

/// The mean over directions of 1 minus a row's values, by cosine; samples are denser at small cosines.
double mean_lost(const float* row, double alpha) {
  constexpr int places = 256;
  double sum = 0;
  for (int i = 0; i < places; ++i) {
    const double s = (i + 0.5) / places, cosine = s * s * s;
    sum += (1 - in_row(row, place_of(cosine, alpha, GLASS_STEPS))) * 2 * cosine * 3 * s * s;
  }
  return std::max(sum / places, 0.0);
}

/// 1 - 1 / eta of the thicker medium. Equal indices make no interface, so the first entry has a slight
/// difference.
double less_of(u32 index) {
  const double root = double(index) / (GLASS_INDICES - 1);
  return std::max(double(GLASS_REACH) * root * root, 1e-3);
}

/// The fraction of uniform light that enters the thicker medium.
double mean_entering(double eta) {
  double sum = 0, bent = 0;
  for (int i = 0; i < 256; ++i) {
    const double c = (i + 0.5) / 256;
    sum += 2 * c * (1 - reflectance(c, eta, bent));
  }
  return sum / 256;
}

/// Adds the mean loss at the first facet, and the share of the lost light that enters the thicker medium.
void add_further(std::vector<float>& table) {
  table.resize(GLASS_LOST + GLASS_INDICES * 2 * GLASS_STEPS);
  for (u32 i = 0; i < GLASS_INDICES * 2 * GLASS_STEPS; ++i) {
    const double alpha = alpha_of(i % GLASS_STEPS, GLASS_STEPS);
    const double lost = mean_lost(&table[LOBE_GLASS + i * GLASS_STEPS], alpha);
    table[GLASS_LOST + i] = static_cast<float>(lost / (alpha * alpha));
  }
  for (u32 i = 0; i < GLASS_INDICES * GLASS_STEPS; ++i)
    table[GLASS_THROUGH + i] = static_cast<float>(mean_entering(1 / (1 - less_of(i / GLASS_STEPS))));
}

void add_glass(std::vector<float>& table) {
  table.resize(LOBE_GLASS + GLASS_INDICES * 2 * GLASS_STEPS * GLASS_STEPS);
  tbb::parallel_for(0u, GLASS_STEPS * GLASS_STEPS, [&](u32 place) {
    const u32 row = place / GLASS_STEPS, column = place % GLASS_STEPS;
    const double alpha = alpha_of(row, GLASS_STEPS), cosine = cosine_of(column, GLASS_STEPS, alpha);
    const dvec3 wo(std::sqrt(1 - cosine * cosine), 0, cosine);
    const Normals normals = visible_normals(wo, alpha);
    for (u32 i = 0; i < GLASS_INDICES * 2; ++i) {
      const double less = less_of(i / 2), eta = i % 2 == 0 ? 1 / (1 - less) : 1 - less;
      const double lost = 1 - glass_energy(wo, normals, alpha, eta);
      table[LOBE_GLASS + (i * GLASS_STEPS + row) * GLASS_STEPS + column] =
          static_cast<float>(1 - std::max(lost - glass_margin, lost / 2));
    }
  });
}

}  // namespace

std::vector<float> make_lobe_energy(LobeTables wanted) {
  std::vector<float> table;
  for (u32 row = 0; row < LOBE_STEPS; ++row) {
    const double alpha = alpha_of(row, LOBE_STEPS);
    for (u32 column = 0; column < LOBE_STEPS; ++column)
      table.push_back(static_cast<float>(energy(cosine_of(column, LOBE_STEPS, alpha), alpha)));
  }
  if (wanted.gains) add_gains(table);
  if (wanted.glass) {
    add_glass(table);
    add_further(table);
  }
  return table;
}

}  // namespace sundog
