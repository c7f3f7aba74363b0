// Divides a frame among devices by their speeds, pixels and seconds. Pure functions, independent of devices
// and clocks.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace sundog {

/// Above this ratio of speeds, a device loses more by sharing its cores than the slower device adds.
constexpr double burden_factor = 8;

/// Above this ratio of estimates, the slower of two devices on the same cores is not even started: compiling
/// for it would cost the frame more time than it can ever save.
constexpr double hopeless_factor = 64;

/// The known facts about a device's speed.
struct DeviceSpeed {
  double measured = 0;      // pixels per second; 0: not measured yet
  double sample = 0;        // pixels in that measurement
  double estimate = 0;      // relative to the other devices, from their properties; 0: unknown
  int processor = -1;       // devices with equal numbers share cores; -1: own hardware
  double tile_seconds = 0;  // maximum length of its tiles; 0: the planner decides
  bool working = false;     // ready and neither retired nor stuck
  bool failed = false;      // retired or stuck
};

/// Expected pixels per second of a device: measured, or its estimate scaled by the measured devices; 0 if
/// unknown.
double expected_speed(std::span<const DeviceSpeed> devices, std::size_t device);

/// Pixels of the next tile for `device` when `left` are waiting: half of its share by speed, so that tiles
/// shrink towards the end. The first tile is a small probe; from tile to tile, the size grows at most
/// fourfold. 0: the device should rest, because the others finish everything sooner, or because it shares
/// cores with a much faster device. The fastest working device never rests.
std::uint64_t guided_pixels(std::span<const DeviceSpeed> devices, std::size_t device, std::uint64_t left);

/// Whether a device should not be started, because one on the same cores that has not failed is estimated
/// hopeless_factor times as fast.
bool is_spared(std::span<const DeviceSpeed> devices, std::size_t device);

/// A tile being rendered by one or more devices.
struct HeldTile {
  struct Holder {
    std::size_t device;
    double seconds;  // since it was given the tile
  };
  std::uint64_t pixels = 0;
  std::vector<Holder> holders;
};

/// Whether a holder takes so much longer than its speed suggests (over four times as long, and over a second)
/// that its driver may hang and nobody should wait for it.
bool is_stuck(std::span<const DeviceSpeed> devices, const HeldTile& tile, const HeldTile::Holder& holder);

/// Seconds until the first of its holders will probably finish the tile. An overdue holder is expected to
/// need as long again as it is overdue; a holder of unknown speed, as long again as it has taken; a stuck
/// holder, forever.
double seconds_left(std::span<const DeviceSpeed> devices, const HeldTile& tile);

/// The index of the tile that an idle `device` should also render to finish the frame sooner: of those that
/// it would finish well before their holders, the one that would last longest. None if there is no such tile.
std::optional<std::size_t> tile_to_repeat(std::span<const DeviceSpeed> devices, std::size_t device,
                                          std::span<const HeldTile> tiles);

/// One device's work in a frame.
struct DeviceWork {
  std::uint64_t pixels = 0, kept_pixels = 0;  // rendered; of those, kept (duplicates are kept once)
  double busy_seconds = 0;                    // rendering tiles
  double ready_seconds = 0;                   // from ready to the end of the frame
};

/// Pixels kept, divided by the pixels that the devices could have rendered while ready, each at its own
/// speed: 1 if nobody waited and nothing was duplicated, or nothing was rendered.
double efficiency(std::span<const DeviceWork> devices);

}  // namespace sundog
