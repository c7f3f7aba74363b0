// See facets.h. The lobe is that of kernels/lib/shade/layer_lobes.cl.
#include "compile/layers/facets.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace sundog {
namespace {

using glm::dvec3;

constexpr int facet_draws = 610, facet_turn = 377;  // a Fibonacci lattice of facets

double squared(double x) { return x * x; }

double hidden_by(const dvec3& w, const FacetWidths& a) {
  const double stretched = squared(a.x * w.x) + squared(a.y * w.y);
  return (std::sqrt(1 + stretched / std::max(w.z * w.z, 1e-12)) - 1) / 2;
}

dvec3 facet_seen_from(const dvec3& wo, const FacetWidths& a, double u, double v) {
  const dvec3 stretched = glm::normalize(dvec3(a.x * wo.x, a.y * wo.y, wo.z));
  const double z = (1 - v) * (1 + stretched.z) - stretched.z, side = std::sqrt(std::max(1 - z * z, 0.0));
  const double turn = 2 * std::numbers::pi * u;
  const dvec3 h = dvec3(side * std::cos(turn), side * std::sin(turn), z) + stretched;
  return glm::normalize(dvec3(a.x * h.x, a.y * h.y, std::max(h.z, 1e-6)));
}

/// Light of white facets, each drawn with the same weight: where it comes from, the part that is sent on, and
/// the cosine to the facet.
struct SentLight {
  dvec3 from;
  double part, cosine;
};

std::vector<SentLight> light_sent_to(const dvec3& wo, const FacetWidths& a) {
  std::vector<SentLight> sent;
  const double seen = 1 + hidden_by(wo, a);
  for (int i = 0; i < facet_draws; ++i) {
    const double u = double(i * facet_turn % facet_draws) / facet_draws;
    const dvec3 h = facet_seen_from(wo, a, u, (i + 0.5) / facet_draws);
    const double c = std::clamp(glm::dot(wo, h), 0.0, 1.0);
    const dvec3 wi = 2 * c * h - wo;
    if (wi.z > 0) sent.push_back({wi, seen / (seen + hidden_by(wi, a)), c});
  }
  return sent;
}

double gain_for(const FacetGains& gains, const dvec3& w) {
  const double along = w.x * w.x, flat = std::max(along + w.y * w.y, 1e-12);
  const double y = along / flat * (LAYER_TURNS - 1);
  const auto row = std::min(static_cast<std::size_t>(y), std::size_t{LAYER_TURNS - 2});
  return std::lerp(at_cosine(gains[row], w.z), at_cosine(gains[row + 1], w.z), y - double(row));
}

double turn_of_row(std::size_t row) { return std::acos(std::sqrt(double(row) / (LAYER_TURNS - 1))); }

double white_returned(const FacetGains& gains, const dvec3& wo, const std::vector<SentLight>& sent) {
  double sum = 0;
  for (const SentLight& one : sent) sum += one.part * gain_for(gains, one.from);
  return sum * gain_for(gains, wo) / facet_draws;
}

}  // namespace

double interface_reflects(double c, const Interface& interface) {
  const double eta = interface.eta, behind2 = 1 - (1 - c * c) / (eta * eta);
  const double behind = std::sqrt(std::max(behind2, 0.0));
  const double s = (c - eta * behind) / (c + eta * behind), p = (eta * c - behind) / (eta * c + behind);
  const double plain = eta == 1 ? 0 : behind2 <= 0 ? 1 : (s * s + p * p) / 2;
  return interface.film > 0 ? std::lerp(plain, at_cosine(interface.film_row, c), interface.film) : plain;
}

FacetGains facet_gains(const FacetWidths& widths) {
  const std::size_t turns = widths.x == widths.y ? 1 : LAYER_TURNS;
  std::vector<std::vector<SentLight>> sent(turns * LAYER_STEPS);
  const auto viewer_of = [](std::size_t i) {
    return viewer(layer_cosine(i % LAYER_STEPS), turn_of_row(i / LAYER_STEPS));
  };
  tbb::parallel_for(std::size_t{0}, sent.size(),
                    [&](std::size_t i) { sent[i] = light_sent_to(viewer_of(i), widths); });
  FacetGains gains;
  for (AlbedoRow& row : gains) row.fill(1);
  for (int round = 0; round < 12; ++round) {
    FacetGains next = gains;
    tbb::parallel_for(std::size_t{0}, sent.size(), [&](std::size_t i) {
      next[i / LAYER_STEPS][i % LAYER_STEPS] /= std::sqrt(white_returned(gains, viewer_of(i), sent[i]));
    });
    gains = next;
    for (std::size_t row = turns; row < LAYER_TURNS; ++row) gains[row] = gains[0];
  }
  return gains;
}

FacetAlbedo facet_albedo(const FacetWidths& widths, const FacetGains& gains, const Interface& interface) {
  const std::size_t turns = widths.x == widths.y ? 1 : 4;
  FacetAlbedo albedo{};
  AlbedoRow most{};
  tbb::parallel_for(std::size_t{0}, std::size_t{LAYER_STEPS}, [&](std::size_t i) {
    for (std::size_t k = 0; k < turns; ++k) {
      const dvec3 wo =
          viewer(layer_cosine(i), turns == 1 ? 0 : std::numbers::pi / 2 * double(k) / double(turns - 1));
      const std::vector<SentLight> sent = light_sent_to(wo, widths);
      const double gain_o = gain_for(gains, wo);
      double sum = 0;
      for (const SentLight& one : sent) {
        const double f = interface_reflects(one.cosine, interface);
        sum += one.part * f * (1 + f * (gain_o * gain_for(gains, one.from) - 1));
      }
      albedo.of_interface[i] = std::max(albedo.of_interface[i], sum / facet_draws);
      most[i] = std::max(most[i], white_returned(gains, wo, sent));
    }
  });
  albedo.scale = 1 / std::max(1.0, *std::ranges::max_element(most));
  return albedo;
}

}  // namespace sundog
