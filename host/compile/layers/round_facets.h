// Facets as wide across as along, between the widths of tables that are computed when sundog is built: a
// layered material costs microseconds, where its own quadrature takes a millisecond.
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "compile/layers/facets.h"

namespace sundog {

inline constexpr std::size_t round_widths = 48, round_groups = 40;

/// A group of facets that a viewer sees: the cosine to their normals, the part of all light that they send on
/// where they are white, and the same times the gains of where it comes from.
struct FacetGroup {
  float cosine, part, gained;
};

/// Facets of one width, as rows of the cosine to the viewer.
struct RoundFacets {
  std::array<float, LAYER_STEPS> gains;
  float most;  // that white ones return, with the gains
  std::array<std::array<FacetGroup, round_groups>, LAYER_STEPS> groups;
};

/// By quadrature.
RoundFacets make_round_facets(double alpha);

/// All tables one behind another: the facets, and the albedo of fuzz, at round_width() of each row.
std::vector<float> make_layer_tables();
/// The same, computed when sundog was built.
std::span<const float> built_layer_tables();

/// The width of a table's row.
double round_width(std::size_t row);

/// From LEAST_LAYER_ALPHA to 1, between the rows of the tables. facet_gains() and facet_albedo() within 1e-3
/// (an interface's reflectance is that of each group's mean cosine).
RoundFacets round_facets(double alpha);
FacetAlbedo albedo_of(const RoundFacets& facets, const Interface& interface);

/// Facets of any widths: where these are two, by quadrature.
class Facets {
 public:
  explicit Facets(const FacetWidths& widths);
  const FacetGains& gains() const { return gains_; }
  FacetAlbedo albedo(const Interface& interface) const;

 private:
  FacetWidths widths_;
  std::optional<RoundFacets> round_;
  FacetGains gains_;
};

/// fuzz_albedo(), between the rows of its table.
AlbedoRow fuzz_between(double alpha);

}  // namespace sundog
