// Traces photons in launches, sorts them by cell on the host, and uploads as many maps as fit; radii shrink
// after Knaus and Zwicker (2011).
#include "render/device/photon_maps.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "base/environment.h"
#include "base/faults.h"
#include "render/device/photon_beams.h"
#include "shared/sampler.h"

namespace sundog {
namespace {

constexpr double kept_part = 2.0 / 3;       // alpha: 1 keeps the radius, smaller values shrink it faster
constexpr u32 photons_a_launch = 1u << 16;  // a launch stays well below a second on any device
constexpr u32 least_cells = 1024;
constexpr std::size_t most_lanes = 16;
// With default settings, the smaller holds the photons of 1024 samples, the larger those of 30,000.
constexpr std::uint64_t least_room = std::uint64_t{608} << 20, most_room = std::uint64_t{2} << 30;

/// Memory budget of all maps on the device: a quarter of its memory, within these bounds, and at most its
/// largest allocation.
std::uint64_t room_on(const DeviceInfo& info) {
  const auto kibibytes = fault(value_of(info.environment).faults, "photons", info.place());
  if (kibibytes) return static_cast<std::uint64_t>(*kibibytes) << 10;
  const std::uint64_t room = std::clamp(info.global_memory / 4, least_room, most_room);
  return info.max_allocation > 0 ? std::min(room, info.max_allocation) : room;
}

/// Sorts photons by cell, then by number: first all positions, then their light. `begins` receives the start
/// of each cell and the end of the last. A copy of the first cell follows the last one, for rows that end
/// there.
std::vector<float4> sort_photons(const std::vector<float4>& landed, const std::vector<u32>& cells, u32 mask,
                                 std::vector<u32>& begins) {
  begins.assign(std::size_t{mask} + 2, 0);
  for (const u32 cell : cells)
    if (cell != NO_PHOTON) ++begins[(cell & mask) + 1];
  std::partial_sum(begins.begin(), begins.end(), begins.begin());
  std::vector<u32> next(begins.begin(), begins.end() - 1);  // next free place of each cell
  const std::size_t landings = begins.back(), again = begins[1], count = landings + again;
  begins.push_back(static_cast<u32>(count));
  std::vector<float4> sorted(2 * count);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (cells[i] == NO_PHOTON) continue;
    const std::size_t to = next[cells[i] & mask]++;
    sorted[to] = landed[2 * i];
    sorted[count + to] = landed[2 * i + 1];
  }
  for (const std::size_t row : {std::size_t{0}, count})
    std::copy_n(sorted.begin() + std::ptrdiff_t(row), again, sorted.begin() + std::ptrdiff_t(row + landings));
  return sorted;
}

/// Beams of a map. Each sample of the map searches its whole share of them.
std::size_t beams_of(u32 photons) { return std::max(photons / 64, 256u); }

template <class T>
void append(std::vector<T>& list, const std::vector<T>& more) {
  list.insert(list.end(), more.begin(), more.end());
}

}  // namespace

double shrunk_radius(u32 number) {
  double square = 1;
  for (u32 i = 1; i <= number; ++i) square *= (i + kept_part) / (i + 1.0);
  return std::sqrt(square);
}

bool PhotonMaps::prepare(const PhotonTracer& tracer, const StopFlags& flags, u32 first, u32 last) {
  if (targets_ == 0 || last <= first) return true;
  wanted_end_ = photon_map_of(last - 1) + 1;
  const u32 number = photon_map_of(first);
  const bool all = holds(number) && (wanted_end_ <= end_map_ || full_);
  return all || fill(tracer, flags, number);
}

void PhotonMaps::make_room(const PhotonTracer& tracer) {
  if (landed_.count > 0) return;
  Device& device = tracer.device;
  landed_ = device.make<float4>(std::size_t{scatters_ ? 5u : 2u} * photons_a_launch);
  cells_ = device.make<u32>(photons_a_launch);
  const std::vector<u32> outside(2 * lights_);
  light_media_ = device.upload(std::span<const u32>(outside));
  if (!plan_.lights_inside) return;
  const KernelConfig& config = tracer.kernels.config;
  auto find = scene_kernel<Buffer<u32>>(
      device.build("entry/light_media.cl", config.defines(), nullptr, config.generated), "find_light_media");
  run_scene_kernel(device, find, {lights_, 1, 1, 1}, tracer.kernels.tables, light_media_);
  device.finish();
}

void PhotonMaps::trace(const PhotonTracer& tracer, const PhotonLaunch& launch) {
  constexpr double expected = 3;  // unknown, so only minutes count as stuck
  FrameKernels& kernels = tracer.kernels;
  const std::size_t batch = std::size_t{kernels.config.tile_w} * kernels.config.tile_h;
  const std::size_t items = (launch.last - launch.first + batch - 1) / batch;
  const std::size_t group = photon_group(kernels.config, kernels.most_group);
  const WatchedLaunch watched(tracer.watch, expected, !traced_,
                              value_of(tracer.device.info().environment).launch_limit);
  run_scene_kernel(tracer.device, kernels.trace_photons, {.x = items, .local_x = group}, kernels.tables,
                   light_media_, landed_, cells_, launch);
  tracer.device.finish();
  traced_ = true;
}

PhotonMaps::Made PhotonMaps::make(const PhotonTracer& tracer, u32 number) {
  make_room(tracer);
  const std::size_t count = plan_.count;
  std::vector<float4> landed(2 * count);
  std::vector<u32> cells(count);
  std::vector<float4> beams(scatters_ ? 3 * count : 0);
  Made made;
  made.map.number = number;
  made.map.radius = static_cast<float>(plan_.radius * shrunk_radius(number));
  made.map.inverse_edge = 0.5f / made.map.radius;
  for (u32 first = 0; first < plan_.count; first += photons_a_launch) {
    const u32 last = std::min(plan_.count, first + photons_a_launch);
    trace(tracer, {number, first, last, plan_.count, targets_, made.map.inverse_edge, 0, 0});
    const std::size_t begin = first, some = last - first;
    tracer.device.read(landed_, std::span(landed).subspan(2 * begin, 2 * some));
    if (scatters_) tracer.device.read(landed_, std::span(beams).subspan(3 * begin, 3 * some), 2 * some);
    tracer.device.read(cells_, std::span(cells).subspan(begin, some));
  }
  const auto lost = static_cast<u32>(std::ranges::count(cells, NO_PHOTON));
  made.map.cell_mask = std::bit_ceil(std::max(plan_.count - lost, least_cells)) - 1;
  made.photons = sort_photons(landed, cells, made.map.cell_mask, made.cells);
  made.map.first_beam = static_cast<u32>(made.photons.size());
  made.map.photons = made.map.first_beam / 2;
  const std::vector<float4> groups = group_beams(beams, beams_of(plan_.count), number, made.map.radius);
  append(made.photons, groups);
  made.map.beam_groups = static_cast<u32>(groups.size()) / (BEAM_GROUP_ROWS * PHOTON_MAP_SAMPLES);
  return made;
}

/// Makes maps from `number` on, until all needed ones exist or memory is full.
bool PhotonMaps::fill(const PhotonTracer& tracer, const StopFlags& flags, u32 number) {
  std::vector<PhotonMap> maps;
  std::vector<u32> cells;
  std::vector<float4> photons;
  first_map_ = end_map_ = 0;
  full_ = false;
  const std::uint64_t room = room_on(tracer.device.info());
  const u32 wanted = std::max(wanted_end_, number + 1);
  u32 next = number;
  for (; next < wanted; ++next) {
    if (flags.set()) return false;
    Made made = make(tracer, next);
    const std::size_t bytes = photons.size() * sizeof(float4) + cells.size() * sizeof(u32) + made.bytes();
    full_ = next > number && bytes > room;
    if (full_) break;
    made.map.first_cell = static_cast<u32>(cells.size());
    made.map.first_beam += static_cast<u32>(photons.size());
    const auto before = static_cast<u32>(photons.size());
    for (u32& begin : made.cells) begin += before;
    maps.push_back(made.map);
    append(cells, made.cells);
    append(photons, made.photons);
  }
  photons.resize(photons.size() + most_lanes);  // kernels read these past the end, but do not use them
  DeviceScene& tables = tracer.kernels.tables;
  tables.photon_maps = tracer.device.upload(std::span<const PhotonMap>(maps));
  tables.photon_cells = tracer.device.upload(std::span<const u32>(cells));
  tables.photons = tracer.device.upload(std::span<const float4>(photons));
  first_map_ = number;
  end_map_ = next;
  return true;
}

u32 PhotonMaps::end_of_maps(u32 first, u32 last) const {
  if (targets_ == 0) return last;
  u32 end = first;
  while (end < last && holds(photon_map_of(end))) ++end;
  return end;
}

}  // namespace sundog
