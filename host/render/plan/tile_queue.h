// The frame's tiles, shared by the threads that serve the devices: who makes what by plan.h, what failed goes
// to others, and what comes twice counts once.
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

/// What the tiles are shared out by.
struct TilePlan {
  /// One list for all devices, or one a device (a static split).
  std::vector<WaitingTiles> lists;
  bool whole = false;  // the lists' tiles are handed out uncut
  bool exact = false;  // of lists a device: nobody makes another's tile too, not even the last
};

class TileQueue {
 public:
  /// `devices` hold estimates; none is working yet.
  TileQueue(TilePlan plan, std::vector<DeviceSpeed> devices);

  /// The frame has passes: when the tiles are made there are more to come, by refill(), until no_more().
  void expect_more();
  void refill(TilePlan plan);
  void no_more();
  /// The tiles are made, and more are expected.
  bool waits_for_more() const;

  /// Waits while the device is better not started (is_spared); false when it never will be, because the
  /// frame is finished or closed. In a fixed split every device is needed.
  bool wait_until_needed(std::size_t device);
  /// The device has built its kernels and will ask for tiles.
  void ready(std::size_t device);
  /// The next tile for a device: a waiting one, or, when none is left for it, one that another device is
  /// making and that this one would finish sooner. Waits while there may come one; nullopt when the frame is
  /// finished or closed.
  std::optional<TileJob> take(std::size_t device);
  /// A tile was made, in `seconds`. True: it is the first to come and counts. The others that make it are
  /// told to stop by their cancelled().
  bool finished(std::size_t device, const TileJob& job, double seconds);
  /// Only a part of the tile was made, because the frame was stopped or another was faster. True: no other
  /// device has finished the tile or given a part of it.
  bool given_up(std::size_t device, const TileJob& job);
  /// The device could not make the tile: it waits for anybody again.
  void failed(std::size_t device, const TileJob& job);
  /// No tile that the device is given from now on has more than half the pixels of `tile`.
  void halve(std::size_t device, const Tile& tile);
  /// The device takes no more tiles. What it still holds, and what was set aside for it, others may take.
  void retire(std::size_t device);
  /// No more tiles for anybody.
  void close();
  /// Waits until the frame is finished or closed, at most so long; true when it is.
  bool wait(double seconds);

  /// Set when the tile in hand has been finished by another. Reset by take().
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
    double recent_pixels = 0, recent_seconds = 0;  // older tiles count less
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
  WaitingTiles returned_;  // failed, or left over by a retired device
  std::vector<DeviceSpeed> speeds_;
  std::vector<std::unique_ptr<State>> devices_;
  std::map<std::uint64_t, Held> held_;
  std::uint64_t next_id_ = 1;
  std::uint64_t unfinished_ = 0;  // pixels, waiting or held
  bool closed_ = false;
  bool more_ = false;  // another pass may follow
};

}  // namespace sundog
