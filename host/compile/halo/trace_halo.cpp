// Traces halos on the host with the kernels' functions, compiled as C++.
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <algorithm>

#include "compile/halo/halo_map.h"

namespace sundog {
namespace {

#include "compile/halo/host_lanes.h"
#include "halo_lanes.inc"

/// One thread's counts.
struct Counts {
  std::vector<u32> cells, tallies;
};

void add_wide(std::span<u32> tallies, std::size_t which, u32 low, u32 high) {
  tallies[2 * which] += low;
  tallies[2 * which + 1] += high + (tallies[2 * which] < low ? 1u : 0u);
}

}  // namespace

void trace_halo_launch(const HaloLaunch& launch, std::span<u32> cells, std::span<u32> tallies) {
  constexpr u32 rays_an_item = LANES * HALO_RAYS_A_LANE;
  for (u32 item = 0; item * rays_an_item < launch.count; ++item) {
    HaloSums sums{};
    const u32 first = item * rays_an_item;
    trace_crystals(&launch, cells.data(), UINTS::Vector{first, first + 1, first + 2, first + 3}, LANES, &sums,
                   ALL_LANES);
    for (std::size_t which = 0; which < HALO_TALLIES; ++which)
      for (int lane = 0; lane < LANES; ++lane)
        add_wide(tallies, which, static_cast<u32>(sums.weights[which].v[lane]), 0);
  }
}

HaloMap trace_halo(const HaloPlan& plan, const std::function<bool(std::uint64_t)>& progress) {
  const auto cell_count = static_cast<std::size_t>(plan.side) * static_cast<std::size_t>(plan.side);
  HaloSum sum(plan);
  tbb::enumerable_thread_specific<Counts> counts;
  std::uint64_t done = 0;
  for (std::size_t band = 0; band < plan.bands.size(); ++band) {
    const std::vector<HaloLaunch>& launches = plan.bands[band];
    tbb::parallel_for(std::size_t{0}, launches.size(), [&](std::size_t i) {
      Counts& mine = counts.local();
      mine.cells.resize(cell_count);
      mine.tallies.resize(halo_tally_words);
      trace_halo_launch(launches[i], mine.cells, mine.tallies);
    });
    std::vector<u32> cells(cell_count), tallies(halo_tally_words);
    for (Counts& each : counts) {
      for (std::size_t i = 0; i < cell_count; ++i) cells[i] += each.cells[i];
      for (std::size_t which = 0; which < HALO_TALLIES; ++which)
        add_wide(tallies, which, each.tallies[2 * which], each.tallies[2 * which + 1]);
      std::ranges::fill(each.cells, 0u);
      std::ranges::fill(each.tallies, 0u);
    }
    sum.add(band, cells, tallies);
    for (const HaloLaunch& launch : launches) done += launch.count;
    if (progress && !progress(done)) return {};
  }
  return sum.map();
}

}  // namespace sundog
