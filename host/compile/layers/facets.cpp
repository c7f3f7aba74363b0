// Samples the visible facets of the lobe in kernels/plain/shade/layer_lobes.cl on a Fibonacci lattice, and
// finds the gains in 12 rounds of scaling.
#include "compile/layers/facets.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <vector>

#include "compile/layers/round_facets.h"
#include "compile/view/lattice_turns.h"

namespace sundog {
namespace {

using glm::dvec3;

constexpr int facet_draws = 610, facet_turn = 377;  // a Fibonacci lattice of facets

double squared(double x) { return x * x; }

double hidden_by(const dvec3& w, const FacetWidths& a) {
  const double stretched = squared(a.x * w.x) + squared(a.y * w.y);
  return (std::sqrt(1 + stretched / std::max(w.z * w.z, 1e-12)) - 1) / 2;
}

/// `stretched`: the viewer, scaled so that facets have slope 1.
dvec3 facet_seen_from(const dvec3& stretched, const FacetWidths& a, const LatticeTurn& turn, double v) {
  const double z = (1 - v) * (1 + stretched.z) - stretched.z, side = std::sqrt(std::max(1 - z * z, 0.0));
  const dvec3 h = dvec3(side * turn.cosine, side * turn.sine, z) + stretched;
  return glm::normalize(dvec3(a.x * h.x, a.y * h.y, std::max(h.z, 1e-6)));
}

/// The cell of a direction in the gains, and interpolation weights.
struct GainPlace {
  unsigned row, column;
  double to_next_row, to_next_column;
};

/// `one_row`: all rows of the gains are equal.
GainPlace place_of(const dvec3& w, bool one_row) {
  const double x = std::clamp(w.z, 0.0, 1.0) * (LAYER_STEPS - 1);
  const unsigned column = std::min(static_cast<unsigned>(x), LAYER_STEPS - 2);
  if (one_row) return {0, column, 0, x - double(column)};
  const double along = w.x * w.x, flat = std::max(along + w.y * w.y, 1e-12);
  const double y = along / flat * (LAYER_TURNS - 1);
  const unsigned row = std::min(static_cast<unsigned>(y), LAYER_TURNS - 2);
  return {row, column, y - double(row), x - double(column)};
}

/// std::lerp without branches, for positive a and b and t from 0 to 1.
double between(double a, double b, double t) {
  const double x = a + t * (b - a), bounded = b > a ? std::min(x, b) : std::max(x, b);
  return t == 1 ? b : bounded;
}

double gain_at(const FacetGains& gains, const GainPlace& at) {
  const auto in_row = [&](const AlbedoRow& row) {
    return between(row[at.column], row[at.column + 1], at.to_next_column);
  };
  const double first = in_row(gains[at.row]);
  return at.to_next_row == 0 ? first : between(first, in_row(gains[at.row + 1]), at.to_next_row);
}

/// Light from an equally weighted white facet: its origin, the fraction reflected, and the cosine to the
/// facet.
struct SentLight {
  GainPlace from;
  double part, cosine;
};

std::vector<SentLight> light_sent_to(const dvec3& wo, const FacetWidths& a, bool one_row) {
  const auto& turns = lattice_turns<facet_draws, facet_turn>();
  std::vector<SentLight> sent;
  sent.reserve(facet_draws);
  const double seen = 1 + hidden_by(wo, a);
  const dvec3 stretched = glm::normalize(dvec3(a.x * wo.x, a.y * wo.y, wo.z));
  for (int i = 0; i < facet_draws; ++i) {
    const dvec3 h =
        facet_seen_from(stretched, a, turns[static_cast<std::size_t>(i)], (i + 0.5) / facet_draws);
    const double c = std::clamp(glm::dot(wo, h), 0.0, 1.0);
    const dvec3 wi = 2 * c * h - wo;
    if (wi.z > 0) sent.push_back({place_of(wi, one_row), seen / (seen + hidden_by(wi, a)), c});
  }
  return sent;
}

double turn_of_row(std::size_t row) { return std::acos(std::sqrt(double(row) / (LAYER_TURNS - 1))); }

double white_returned(const FacetGains& gains, const GainPlace& wo, const std::vector<SentLight>& sent) {
  double sum = 0;
  for (const SentLight& one : sent) sum += one.part * gain_at(gains, one.from);
  return sum * gain_at(gains, wo) / facet_draws;
}

/// Groups facets by cosine, each with an equal share of light.
std::array<FacetGroup, round_groups> grouped(std::vector<SentLight> sent, const FacetGains& gains) {
  std::ranges::sort(sent, {}, &SentLight::cosine);
  double all = 0;
  for (const SentLight& one : sent) all += one.part;
  std::array<dvec3, round_groups> sums{};  // of cosines, fractions and fractions with gains
  double before = 0;
  for (const SentLight& one : sent) {
    const double end = before + one.part;
    // A facet that straddles groups is divided between them.
    for (double from = before; from < end;) {
      const auto group = std::min(static_cast<std::size_t>(from / all * round_groups), round_groups - 1);
      const double limit =
          group + 1 == round_groups ? end : std::min(end, all * double(group + 1) / round_groups);
      const double share = limit > from ? limit - from : end - from;
      sums[group] += share * dvec3(one.cosine, 1, gain_at(gains, one.from));
      from += share;
    }
    before = end;
  }
  std::array<FacetGroup, round_groups> groups;
  for (std::size_t i = 0; i < round_groups; ++i)
    groups[i] = {float(sums[i].x / sums[i].y), float(sums[i].y / facet_draws),
                 float(sums[i].z / facet_draws)};
  return groups;
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
  const bool one_row = widths.x == widths.y;
  const std::size_t turns = one_row ? 1 : LAYER_TURNS;
  std::vector<std::vector<SentLight>> sent(turns * LAYER_STEPS);
  const auto viewer_of = [](std::size_t i) {
    return viewer(layer_cosine(i % LAYER_STEPS), turn_of_row(i / LAYER_STEPS));
  };
  tbb::parallel_for(std::size_t{0}, sent.size(),
                    [&](std::size_t i) { sent[i] = light_sent_to(viewer_of(i), widths, one_row); });
  FacetGains gains;
  for (AlbedoRow& row : gains) row.fill(1);
  for (int round = 0; round < 12; ++round) {
    FacetGains next = gains;
    tbb::parallel_for(std::size_t{0}, sent.size(), [&](std::size_t i) {
      const GainPlace wo = place_of(viewer_of(i), one_row);
      next[i / LAYER_STEPS][i % LAYER_STEPS] /= std::sqrt(white_returned(gains, wo, sent[i]));
    });
    gains = next;
    for (std::size_t row = turns; row < LAYER_TURNS; ++row) gains[row] = gains[0];
  }
  return gains;
}

FacetAlbedo facet_albedo(const FacetWidths& widths, const FacetGains& gains, const Interface& interface) {
  const std::size_t turns = widths.x == widths.y ? 1 : 4;
  const bool one_row = std::ranges::all_of(gains, [&](const AlbedoRow& row) { return row == gains[0]; });
  FacetAlbedo albedo{};
  AlbedoRow most{};
  tbb::parallel_for(std::size_t{0}, std::size_t{LAYER_STEPS}, [&](std::size_t i) {
    for (std::size_t k = 0; k < turns; ++k) {
      const dvec3 wo =
          viewer(layer_cosine(i), turns == 1 ? 0 : std::numbers::pi / 2 * double(k) / double(turns - 1));
      const std::vector<SentLight> sent = light_sent_to(wo, widths, one_row);
      const GainPlace place = place_of(wo, one_row);
      const double gain_o = gain_at(gains, place);
      double sum = 0;
      for (const SentLight& one : sent) {
        const double f = interface_reflects(one.cosine, interface);
        sum += one.part * f * (1 + f * (gain_o * gain_at(gains, one.from) - 1));
      }
      albedo.of_interface[i] = std::max(albedo.of_interface[i], sum / facet_draws);
      most[i] = std::max(most[i], white_returned(gains, place, sent));
    }
  });
  albedo.scale = 1 / std::max(1.0, *std::ranges::max_element(most));
  return albedo;
}

RoundFacets make_round_facets(double alpha) {
  const FacetWidths widths{alpha, alpha};
  const FacetGains gains = facet_gains(widths);
  RoundFacets facets{};
  facets.most = 0;
  for (std::size_t i = 0; i < LAYER_STEPS; ++i) {
    const dvec3 wo = viewer(layer_cosine(i), 0);
    const std::vector<SentLight> sent = light_sent_to(wo, widths, true);
    facets.gains[i] = float(gains[0][i]);
    facets.most = std::max(facets.most, float(white_returned(gains, place_of(wo, true), sent)));
    facets.groups[i] = grouped(sent, gains);
  }
  return facets;
}

double round_width(std::size_t row) {
  const double root = std::lerp(std::sqrt(double(LEAST_LAYER_ALPHA)), 1.0, double(row) / (round_widths - 1));
  return root * root;
}

std::vector<float> make_layer_tables() {
  std::vector<float> tables;
  for (std::size_t row = 0; row < round_widths; ++row) {
    const auto values = std::bit_cast<std::array<float, sizeof(RoundFacets) / sizeof(float)>>(
        make_round_facets(round_width(row)));
    tables.insert(tables.end(), values.begin(), values.end());
  }
  for (std::size_t row = 0; row < round_widths; ++row) {
    const AlbedoRow fuzz = fuzz_albedo(round_width(row));
    tables.insert(tables.end(), fuzz.begin(), fuzz.end());
  }
  return tables;
}

}  // namespace sundog
