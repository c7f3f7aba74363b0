// Halos: what is traced, by a device (render/device/halo_tracer.h) or here, and the map that is made of the
// counts. The map is the same to the bit whoever traces.
#pragma once
#include <functional>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "scene/description.h"

namespace sundog {

/// Words of the tallies: pairs, low and high.
inline constexpr std::size_t halo_tally_words = std::size_t{2} * HALO_TALLIES;

/// Rays by bands of wavelengths, and the colours of these.
struct HaloPlan {
  int side = 0;
  std::vector<glm::dvec3> colors;              // linear sRGB, 1 in all
  std::vector<std::vector<HaloLaunch>> bands;  // the launches of each
  std::uint64_t rays = 0;
};

/// Pure.
HaloPlan plan_halo(const EnvironmentDescription& environment);

/// Sums the bands' counts up to a map. Bands in their order; doubles.
class HaloSum {
 public:
  explicit HaloSum(const HaloPlan& plan);
  /// `cells`: the units of one band, plan.side squared; `tallies`: as of the kernel.
  void add(std::size_t band, std::span<const u32> cells, std::span<const u32> tallies);
  HaloMap map() const;

 private:
  const HaloPlan& plan_;
  std::vector<glm::dvec3> sums_;
  double units_ = 0;
  double tallies_[HALO_TALLIES] = {};
};

/// Adds one launch to `cells` and `tallies`, on the calling thread.
void trace_halo_launch(const HaloLaunch& launch, std::span<u32> cells, std::span<u32> tallies);

/// On the host's processor, all threads. `progress` has the rays done, and returns false to give up (then the
/// map is empty).
HaloMap trace_halo(const HaloPlan& plan, const std::function<bool(std::uint64_t)>& progress = {});

/// A steradian's light towards `d`, blended between cells; d: unit, the sun above +x, z up.
glm::dvec3 halo_radiance(const HaloMap& map, const glm::dvec3& d);

/// The part of the cloud's sunlight that one steradian of full light sends from a height: single scattering
/// in a level layer of this optical depth. Sines of the heights of sun and direction.
double halo_depth(double optical_depth, double sun, double direction);

}  // namespace sundog
