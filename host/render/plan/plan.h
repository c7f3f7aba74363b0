// Who gets how much of a frame: arithmetic over speeds, pixels and seconds. Values in, values out; it knows
// no device and no clock.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace sundog {

/// From how many times the speed on a device loses more by sharing its cores than the slower one adds.
constexpr double burden_factor = 8;

/// From how many times the estimate on a device is not even started beside the faster one: compiling for it
/// would take longer from the frame than it can ever give.
constexpr double hopeless_factor = 64;

/// What is known of one device's speed.
struct DeviceSpeed {
  double measured = 0;      // pixels a second; 0: nothing measured yet
  double sample = 0;        // pixels that this was measured by
  double estimate = 0;      // relative to the other devices, from what they report; 0: unknown
  int processor = -1;       // devices with the same number run on the same cores; -1: on its own hardware
  double tile_seconds = 0;  // the longest tile it should be given; 0: the planner's own choice
  bool working = false;     // ready and neither retired nor stuck
  bool failed = false;      // retired or stuck
};

/// Pixels a second that a device can be expected to make: as measured, else its estimate scaled by the
/// devices that have been measured; 0 when there is nothing to go by.
double expected_speed(std::span<const DeviceSpeed> devices, std::size_t device);

/// Pixels of the next tile for `device` when `left` are waiting: half of its share of them by speed, so that
/// tiles shrink towards the end; the first tile is a small one, to measure by, and they grow fourfold at a
/// step. 0: the device had better rest, because the others need less time for all that is left, or because it
/// takes the cores of a device that is many times faster. The fastest of the working devices never rests.
std::uint64_t guided_pixels(std::span<const DeviceSpeed> devices, std::size_t device, std::uint64_t left);

/// Whether a device should not be started, because one on the same cores that has not failed is estimated
/// hopeless_factor times as fast.
bool is_spared(std::span<const DeviceSpeed> devices, std::size_t device);

/// A tile that is being made, by one device or more.
struct HeldTile {
  struct Holder {
    std::size_t device;
    double seconds;  // since it was given the tile
  };
  std::uint64_t pixels = 0;
  std::vector<Holder> holders;
};

/// Whether a holder takes so much longer than its speed lets expect (four times, and a second) that nobody
/// should wait for it: its driver may hang.
bool is_stuck(std::span<const DeviceSpeed> devices, const HeldTile& tile, const HeldTile::Holder& holder);

/// Seconds until the first of its holders is likely to finish the tile. One that is overdue is taken to need
/// as long again as it is overdue; without anything to go by, as long again as it has taken; one that is
/// stuck, for ever.
double seconds_left(std::span<const DeviceSpeed> devices, const HeldTile& tile);

/// The tile (an index) that an idle `device` should make too, because the frame ends sooner that way: of
/// those it would finish well before their holders, the one that would last longest. None when there is no
/// such tile.
std::optional<std::size_t> tile_to_repeat(std::span<const DeviceSpeed> devices, std::size_t device,
                                          std::span<const HeldTile> tiles);

/// What one device did in a frame.
struct DeviceWork {
  std::uint64_t pixels = 0, kept_pixels = 0;  // made; of those, kept (a tile made twice is kept once)
  double busy_seconds = 0;                    // making tiles
  double ready_seconds = 0;                   // from when it was ready to the end of the frame
};

/// Pixels kept, over the pixels that the devices could have made while they were ready, each at its own
/// speed: 1 when nobody waited and nothing was made twice. 1 when nothing was made.
double efficiency(std::span<const DeviceWork> devices);

}  // namespace sundog
