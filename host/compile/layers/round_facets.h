// Isotropic microfacets interpolated from tables computed when sundog is built: a layered material then takes
// microseconds instead of a millisecond of quadrature.
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "compile/layers/facets.h"

namespace sundog {

inline constexpr std::size_t round_widths = 48, round_groups = 40;

/// A group of facets seen by a viewer: the cosine to their normals, the share of light they reflect if white,
/// and that share times the gains of the incoming directions.
struct FacetGroup {
  float cosine, part, gained;
};

/// Facets of one width, as rows over the viewer's cosine.
struct RoundFacets {
  std::array<float, LAYER_STEPS> gains;
  float most;  // maximum albedo of white facets, with gains
  std::array<std::array<FacetGroup, round_groups>, LAYER_STEPS> groups;
};

/// Computes facets by quadrature.
RoundFacets make_round_facets(double alpha);

/// All tables in sequence: the facets and fuzz albedo at round_width() of each row.
std::vector<float> make_layer_tables();
/// make_layer_tables() as computed when sundog was built.
std::span<const float> built_layer_tables();

/// The width of a table row.
double round_width(std::size_t row);

/// Interpolates rows for widths from LEAST_LAYER_ALPHA to 1. Matches facet_gains() and facet_albedo() within
/// 1e-3 (each group reflects as at its mean cosine).
RoundFacets round_facets(double alpha);
FacetAlbedo albedo_of(const RoundFacets& facets, const Interface& interface);

/// Facets of any widths; computes anisotropic ones by quadrature.
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

/// fuzz_albedo(), interpolated from its table.
AlbedoRow fuzz_between(double alpha);

}  // namespace sundog
