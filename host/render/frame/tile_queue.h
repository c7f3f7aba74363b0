// The frame's tiles, shared by the threads of device workers: plan.h decides which device gets which pixels,
// failed tiles go to others, and duplicates count once.
#pragma once
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "base/clock.h"
#include "render/plan/plan.h"
#include "render/plan/tiles.h"

namespace sundog {

struct TileJob {
  std::uint64_t id = 0;
  Tile tile;
};

/// How tiles are distributed.
struct TilePlan {
  /// One list for all devices, or one per device (a static split).
  std::vector<WaitingTiles> lists;
  bool whole = false;  // tiles are not divided
  bool exact = false;  // in a static split, no device repeats another's tile, not even the last
};

class TileQueue {
 public:
  /// `devices` contain estimates; none is working yet.
  TileQueue(TilePlan plan, std::vector<DeviceSpeed> devices);

  /// Expects passes: after finished tiles come refill() or no_more().
  void expect_more();
  void refill(TilePlan plan);
  void no_more();
  /// Whether all tiles are done but more are expected.
  bool waits_for_more() const;

  /// Waits while the device should not be started (is_spared); false if it never should, because the frame is
  /// finished or closed. A fixed split needs every device.
  bool wait_until_needed(std::size_t device);
  /// The device has built its kernels and will request tiles.
  void ready(std::size_t device);
  /// The next tile for a device: a waiting one or, if none is left, one that another device is rendering and
  /// this one would finish sooner. Waits while one may come; nullopt when the frame is finished or closed.
  std::optional<TileJob> take(std::size_t device);
  /// Records that a tile was rendered in `seconds`. Returns true if it is the first result, which counts;
  /// then sets cancelled() for the other devices.
  bool finished(std::size_t device, const TileJob& job, double seconds);
  /// Records that only part of the tile was rendered, because the frame was stopped or another device was
  /// faster. Returns true if no other device has finished the tile or returned a part of it.
  bool given_up(std::size_t device, const TileJob& job);
  /// Records that the device could not render the tile, which waits again for any device.
  void failed(std::size_t device, const TileJob& job);
  /// Limits the device's future tiles to half the pixels of `tile`.
  void halve(std::size_t device, const Tile& tile);
  /// Gives the device no more tiles. Others may take the tiles that it holds or that were reserved for it.
  void retire(std::size_t device);
  /// Hands out no more tiles.
  void close();
  /// Waits until the frame is finished or closed, for at most `seconds`; returns whether it is.
  bool wait(double seconds);

  /// Set when another device has finished the current tile. Reset by take().
  const std::atomic<bool>& cancelled(std::size_t device) const { return devices_[device]->cancelled; }
  bool complete() const;
  DeviceWork work(std::size_t device) const;

 private:
  struct Held {
    Tile tile;
    std::map<std::size_t, Stopwatch> holders;
  };
  struct State {
    std::atomic<bool> cancelled{false};
    bool retired = false;
    double recent_pixels = 0, recent_seconds = 0;  // exponentially weighted
    std::uint64_t most_pixels = ~std::uint64_t{0};
    DeviceWork work;
    std::optional<Stopwatch> ready;
  };

  bool over() const { return closed_ || (unfinished_ == 0 && !more_); }
  static HeldTile as_held(const Held& held);
  void find_stuck();
  WaitingTiles& list_of(std::size_t device);
  bool may_repeat(const Held& held) const;
  std::optional<TileJob> take_waiting(std::size_t device);
  std::optional<TileJob> take_repeated(std::size_t device);
  void release(std::size_t device, std::uint64_t id, bool give_back);
  void measure(std::size_t device, const Tile& tile, double seconds);

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  TilePlan plan_;
  WaitingTiles returned_;  // failed, or left by a retired device
  std::vector<DeviceSpeed> speeds_;
  std::vector<std::unique_ptr<State>> devices_;
  std::map<std::uint64_t, Held> held_;
  std::uint64_t next_id_ = 1;
  std::uint64_t unfinished_ = 0;  // pixels, waiting or held
  bool closed_ = false;
  bool more_ = false;  // another pass may follow
};

}  // namespace sundog
