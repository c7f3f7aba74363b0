// Launches the bands in turn, reads their counts, which are integers and therefore independent of order, and
// adds them to HaloSum.
#include "render/device/halo_tracer.h"

#include <algorithm>
#include <string>

#include "device/choice.h"

namespace sundog {
namespace {

unsigned usual_lanes(const DeviceInfo& device) {
  if (!wants_vectors(device)) return 1;
  return device.native_vector_width >= 16 ? 16 : device.native_vector_width >= 8 ? 8 : 4;
}

SceneProgram program_of(unsigned lanes) {
  return {"entry/trace_halo.cl", {{"LANES", std::to_string(lanes)}, {"TILE_W", "1"}, {"TILE_H", "1"}}, {}};
}

Program build(Device& device, unsigned lanes) {
  const SceneProgram program = program_of(lanes);
  return device.build(program.entry, program.defines);
}

/// One band's counts on the device.
struct Band {
  Buffer<u32> cells, tallies;
  std::vector<u32> cell_values, tally_values;
};

void clear(Device& device, Band& band) {
  std::ranges::fill(band.cell_values, 0u);
  std::ranges::fill(band.tally_values, 0u);
  device.write(band.cells, std::span<const u32>(band.cell_values));
  device.write(band.tallies, std::span<const u32>(band.tally_values));
}

}  // namespace

SceneProgram halo_program(const DeviceInfo& device) { return program_of(usual_lanes(device)); }

void build_halo_kernel(Device& device) { build(device, usual_lanes(device.info())); }

HaloMap trace_halo_on(Device& device, const HaloPlan& plan,
                      const std::function<bool(std::uint64_t)>& progress, const HaloLaunchSizes& sizes) {
  const unsigned lanes = sizes.lanes > 0 ? sizes.lanes : usual_lanes(device.info());
  auto kernel = build(device, lanes).kernel<Buffer<u32>, Buffer<u32>, HaloLaunch>("trace_halo");
  const auto cell_count = static_cast<std::size_t>(plan.side) * static_cast<std::size_t>(plan.side);
  Band counts{device.make<u32>(cell_count), device.make<u32>(halo_tally_words), std::vector<u32>(cell_count),
              std::vector<u32>(halo_tally_words)};
  HaloSum sum(plan);
  std::uint64_t done = 0;
  const std::size_t rays_an_item = std::size_t{lanes} * HALO_RAYS_A_LANE;
  for (std::size_t band = 0; band < plan.bands.size(); ++band) {
    clear(device, counts);
    for (const HaloLaunch& launch : plan.bands[band]) {
      const std::size_t items = (launch.count + rays_an_item - 1) / rays_an_item;
      const std::size_t local = sizes.local > 0 ? sizes.local : lanes > 1 ? 4 : 64;
      device.run(kernel, {.x = items, .local_x = local}, counts.cells, counts.tallies, launch);
      device.finish();
      done += launch.count;
      if (progress && !progress(done)) return {};
    }
    device.read(counts.cells, std::span<u32>(counts.cell_values));
    device.read(counts.tallies, std::span<u32>(counts.tally_values));
    sum.add(band, counts.cell_values, counts.tally_values);
  }
  return sum.map();
}

}  // namespace sundog
