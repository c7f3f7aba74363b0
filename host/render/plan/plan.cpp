// Guided self-scheduling: Polychronopoulos and Kuck, "Guided self-scheduling: a practical scheduling scheme
// for parallel supercomputers" (1987), with shares by measured speed.
#include "render/plan/plan.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sundog {
namespace {

constexpr double longest_tile = 0.25;  // seconds; keeps progress bars moving and checkpoints fresh
// Seconds: long compared with a tile's overhead besides its launches (0.1 ms), short enough that each device
// gets several tiles of a 30 ms frame.
constexpr double shortest_tile = 0.001;
constexpr double unknown_tile = 0.02;  // seconds assumed for a tile on a device of unknown speed
constexpr double growth = 4;           // a tile's pixels relative to those in the speed measurement, at most
constexpr std::uint64_t cell = 16;     // pixels of the smallest tile, 4x4
constexpr std::uint64_t probe = 4096;  // pixels of a device's first tile
constexpr std::uint64_t tiny_probe = 64;  // pixels if the device is expected to be a burden
// A device is stuck if it takes this many times longer than expected, and this many seconds.
constexpr double stuck_factor = 4, stuck_seconds = 1;
constexpr double dearer = 8;  // pixels of one place may take this many times as long as pixels of another
// A repeated tile must be likely to win, because speeds differ over the image.
constexpr double clear_win = 0.8;

/// The total speed of the other devices: those that work, or all that have not failed. Only measured speeds
/// count: an overestimated device would leave crumbs for the others.
double others_speed(std::span<const DeviceSpeed> devices, std::size_t device, bool working) {
  double total = 0;
  for (std::size_t i = 0; i < devices.size(); ++i)
    if (i != device && (working ? devices[i].working : !devices[i].failed)) total += devices[i].measured;
  return total;
}

/// Seconds that a device is expected to need for this many pixels; 0 if unknown.
double expected_seconds(std::span<const DeviceSpeed> devices, std::size_t device, std::uint64_t pixels) {
  const double speed = expected_speed(devices, device);
  return speed > 0 ? static_cast<double>(pixels) / speed : 0;
}

bool is_fastest(std::span<const DeviceSpeed> devices, std::size_t device) {
  const double own = devices[device].measured;
  for (std::size_t i = 0; i < devices.size(); ++i) {
    if (i == device || !devices[i].working) continue;
    const double other = devices[i].measured;
    if (other > own || (other == own && i < device)) return false;
  }
  return true;
}

/// Whether a much faster device works on the same cores. Before the device's own speed is measured, its
/// estimate is used.
bool is_burden(std::span<const DeviceSpeed> devices, std::size_t device) {
  const double own = expected_speed(devices, device);
  if (devices[device].processor < 0 || own <= 0) return false;
  return std::ranges::any_of(devices, [&](const DeviceSpeed& other) {
    return other.working && other.processor == devices[device].processor &&
           other.measured > burden_factor * own;
  });
}

}  // namespace

double expected_speed(std::span<const DeviceSpeed> devices, std::size_t device) {
  if (devices[device].measured > 0) return devices[device].measured;
  double measured = 0, estimates = 0;
  for (const DeviceSpeed& other : devices)
    if (other.measured > 0 && other.estimate > 0) {
      measured += other.measured;
      estimates += other.estimate;
    }
  return estimates > 0 ? measured * devices[device].estimate / estimates : 0;
}

std::uint64_t guided_pixels(std::span<const DeviceSpeed> devices, std::size_t device, std::uint64_t left) {
  if (left == 0) return 0;
  const double own = devices[device].measured;
  const bool slowing = is_burden(devices, device);
  if (own <= 0) {
    const std::uint64_t share = left / (4 * devices.size());
    return std::min(left, std::clamp<std::uint64_t>(share, cell, slowing ? tiny_probe : probe));
  }
  const bool alone = devices.size() == 1;
  const auto waiting = static_cast<double>(left);
  if (!alone && !is_fastest(devices, device)) {
    if (slowing) return 0;
    const double working = others_speed(devices, device, true);
    if (working > 0 && static_cast<double>(std::min(cell, left)) / own > waiting / working) return 0;
  }
  // A device measured in the previous frame counts before it is ready; otherwise the first ready device would
  // take all of a short frame.
  const double others = others_speed(devices, device, false), total = own + others;
  // Half its share if there are equals to balance with; all of it beside devices that hardly count, however
  // much more expensive their pixels are.
  double pixels = waiting * own / total / (1 + std::min(1.0, dearer * others / own));
  const double longest = devices[device].tile_seconds > 0 ? devices[device].tile_seconds : longest_tile;
  pixels = std::clamp(pixels, own * std::min(shortest_tile, longest), own * longest);
  if (devices[device].sample > 0) pixels = std::min(pixels, growth * devices[device].sample);
  // At most its share, with which all devices finish together.
  pixels = std::min(pixels, waiting * own / total);
  return std::min(left, std::max(cell, static_cast<std::uint64_t>(pixels)));
}

bool is_spared(std::span<const DeviceSpeed> devices, std::size_t device) {
  const DeviceSpeed& own = devices[device];
  return own.processor >= 0 && std::ranges::any_of(devices, [&](const DeviceSpeed& other) {
           return !other.failed && other.processor == own.processor &&
                  other.estimate > hopeless_factor * own.estimate;
         });
}

bool is_stuck(std::span<const DeviceSpeed> devices, const HeldTile& tile, const HeldTile::Holder& holder) {
  const double expected = expected_seconds(devices, holder.device, tile.pixels);
  return holder.seconds > stuck_seconds && holder.seconds > stuck_factor * expected;
}

double seconds_left(std::span<const DeviceSpeed> devices, const HeldTile& tile) {
  double least = std::numeric_limits<double>::infinity();
  for (const HeldTile::Holder& holder : tile.holders) {
    if (is_stuck(devices, tile, holder)) continue;
    const double expected = expected_seconds(devices, holder.device, tile.pixels);
    least = std::min(least, std::abs(expected - holder.seconds));
  }
  return least;
}

std::optional<std::size_t> tile_to_repeat(std::span<const DeviceSpeed> devices, std::size_t device,
                                          std::span<const HeldTile> tiles) {
  const double speed = expected_speed(devices, device);
  std::optional<std::size_t> longest;
  double most = 0;
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    const auto is_own = [&](const HeldTile::Holder& holder) { return holder.device == device; };
    if (std::ranges::any_of(tiles[i].holders, is_own)) continue;
    const double theirs = seconds_left(devices, tiles[i]);
    const double own = speed > 0 ? static_cast<double>(tiles[i].pixels) / speed : unknown_tile;
    if (own > clear_win * theirs || theirs <= most) continue;
    most = theirs;
    longest = i;
  }
  return longest;
}

double efficiency(std::span<const DeviceWork> devices) {
  double kept = 0, possible = 0;
  for (const DeviceWork& work : devices) {
    if (work.busy_seconds <= 0) continue;
    kept += static_cast<double>(work.kept_pixels);
    possible += static_cast<double>(work.pixels) / work.busy_seconds *
                std::max(work.ready_seconds, work.busy_seconds);
  }
  return possible > 0 ? kept / possible : 1;
}

}  // namespace sundog
