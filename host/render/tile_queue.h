// The tiles that wait, shared by the devices' threads. A failed tile goes back for another device.
#pragma once
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>
#include <optional>

#include "render/film.h"

namespace sundog {

class TileQueue {
 public:
  explicit TileQueue(std::vector<Tile> tiles) : waiting_(tiles.begin(), tiles.end()), left_(tiles.size()) {}

  /// The next tile. While others still hold tiles that may come back, waits; nullopt when the frame is
  /// finished or closed.
  std::optional<Tile> take() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return closed_ || left_ == 0 || !waiting_.empty(); });
    if (closed_ || left_ == 0) return std::nullopt;
    const Tile tile = waiting_.front();
    waiting_.pop_front();
    return tile;
  }
  void finished() {
    const std::lock_guard lock(mutex_);
    if (--left_ == 0) changed_.notify_all();
  }
  void give_back(const Tile& tile) {
    const std::lock_guard lock(mutex_);
    waiting_.push_front(tile);
    changed_.notify_one();
  }
  /// No more tiles for anybody: the frame was stopped, or nobody is left to work.
  void close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    changed_.notify_all();
  }
  std::size_t left() const {
    const std::lock_guard lock(mutex_);
    return left_;
  }

 private:
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Tile> waiting_;
  std::size_t left_;  // not finished: waiting or held
  bool closed_ = false;
};

}  // namespace sundog
