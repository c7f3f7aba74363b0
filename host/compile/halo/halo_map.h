// Halos: plans the rays to trace, on a device (render/device/halo_tracer.h) or on the host, and sums them to
// a map, which is the same to the bit either way.
#pragma once
#include <functional>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "scene/description.h"

namespace sundog {

/// Number of words of the tallies, each a low and a high word.
inline constexpr std::size_t halo_tally_words = std::size_t{2} * HALO_TALLIES;

/// Rays by wavelength band, and the bands' colours.
struct HaloPlan {
  int side = 0;
  std::vector<glm::dvec3> colors;              // linear sRGB, summing to 1
  std::vector<std::vector<HaloLaunch>> bands;  // launches per band
  std::uint64_t rays = 0;
};

/// Pure.
HaloPlan plan_halo(const EnvironmentDescription& environment);

/// Accumulates the bands' counts, in order and in doubles, to a map.
class HaloSum {
 public:
  explicit HaloSum(const HaloPlan& plan);
  /// `cells`: one band's counts, plan.side squared; `tallies`: from the kernel.
  void add(std::size_t band, std::span<const u32> cells, std::span<const u32> tallies);
  HaloMap map() const;

 private:
  const HaloPlan& plan_;
  std::vector<glm::dvec3> sums_;
  double units_ = 0;
  double tallies_[HALO_TALLIES] = {};
};

/// Traces one launch on the calling thread; adds to `cells` and `tallies`.
void trace_halo_launch(const HaloLaunch& launch, std::span<u32> cells, std::span<u32> tallies);

/// Traces on all host threads. `progress` receives the number of rays done and returns false to cancel (the
/// map is then empty).
HaloMap trace_halo(const HaloPlan& plan, const std::function<bool(std::uint64_t)>& progress = {});

/// Radiance per steradian towards `d`, interpolated between cells; d: unit, the sun above +x, z up.
glm::dvec3 halo_radiance(const HaloMap& map, const glm::dvec3& d);

/// Radiance from single scattering in a horizontal layer of this optical depth, relative to the irradiance
/// facing the sun times the fraction scattered per steradian. Arguments are the sines of the heights of sun
/// and direction.
double halo_depth(double optical_depth, double sun, double direction);

}  // namespace sundog
