// Hands tiles to threads under one lock, and takes back tiles whose device failed.
#include "render/frame/tile_queue.h"

#include <algorithm>
#include <chrono>

namespace sundog {
namespace {

// How often an idle device checks for tiles worth repeating.
constexpr std::chrono::milliseconds between_tiles{10};

// A driver may compile during its first tile, so a device without finished tiles counts as hanging only after
// this time.
constexpr double first_tile_seconds = 10;

}  // namespace

TileQueue::TileQueue(TilePlan plan, std::vector<DeviceSpeed> devices)
    : plan_(std::move(plan)), speeds_(std::move(devices)) {
  for (const WaitingTiles& list : plan_.lists) unfinished_ += list.pixels();
  for (std::size_t i = 0; i < speeds_.size(); ++i) devices_.push_back(std::make_unique<State>());
}

void TileQueue::expect_more() {
  const std::lock_guard lock(mutex_);
  more_ = true;
}

void TileQueue::refill(TilePlan plan) {
  const std::lock_guard lock(mutex_);
  plan_ = std::move(plan);
  for (const WaitingTiles& list : plan_.lists) unfinished_ += list.pixels();
  if (plan_.lists.size() > 1)
    for (std::size_t i = 0; i < devices_.size(); ++i)
      while (devices_[i]->retired) {
        const std::optional<Tile> tile = plan_.lists[i].take_whole();
        if (!tile) break;
        returned_.give_back(*tile);
      }
  changed_.notify_all();
}

void TileQueue::no_more() {
  const std::lock_guard lock(mutex_);
  more_ = false;
  changed_.notify_all();
}

bool TileQueue::waits_for_more() const {
  const std::lock_guard lock(mutex_);
  return unfinished_ == 0 && more_;
}

bool TileQueue::wait_until_needed(std::size_t device) {
  std::unique_lock lock(mutex_);
  while (!over()) {
    find_stuck();
    if (plan_.lists.size() > 1 || !is_spared(speeds_, device)) return true;
    changed_.wait_for(lock, between_tiles);
  }
  return false;
}

void TileQueue::ready(std::size_t device) {
  const std::lock_guard lock(mutex_);
  if (devices_[device]->retired) return;
  speeds_[device].working = true;
  if (!devices_[device]->ready) devices_[device]->ready.emplace();
}

WaitingTiles& TileQueue::list_of(std::size_t device) {
  if (returned_.pixels() > 0) return returned_;
  return plan_.lists.size() == 1 ? plan_.lists.front() : plan_.lists[device];
}

HeldTile TileQueue::as_held(const Held& held) {
  HeldTile tile{pixel_count(held.tile), {}};
  for (const auto& [holder, clock] : held.holders) tile.holders.push_back({holder, clock.seconds()});
  return tile;
}

/// Marks devices whose tile takes much too long, so that others do not wait for them.
void TileQueue::find_stuck() {
  for (std::size_t i = 0; i < speeds_.size(); ++i)
    if (!devices_[i]->retired) {
      speeds_[i].working = devices_[i]->ready.has_value();
      speeds_[i].failed = false;
    }
  for (const auto& [id, held] : held_) {
    const HeldTile tile = as_held(held);
    for (const HeldTile::Holder& holder : tile.holders)
      if (is_stuck(speeds_, tile, holder)) {
        speeds_[holder.device].working = false;
        speeds_[holder.device].failed =
            speeds_[holder.device].measured > 0 || holder.seconds > first_tile_seconds;
      }
  }
}

std::optional<TileJob> TileQueue::take_waiting(std::size_t device) {
  WaitingTiles& list = list_of(device);
  const bool own_list = plan_.lists.size() > 1;  // a static split is kept, however slow the device
  const std::uint64_t wanted = own_list ? guided_pixels(std::span(&speeds_[device], 1), 0, list.pixels())
                                        : guided_pixels(speeds_, device, list.pixels());
  if (wanted == 0) return std::nullopt;
  const std::uint64_t most = devices_[device]->most_pixels;
  const bool whole = plan_.whole && most == ~std::uint64_t{0};
  const std::optional<Tile> tile = whole ? list.take_whole() : list.take(std::min(wanted, most));
  if (!tile) return std::nullopt;
  const TileJob job{next_id_++, *tile};
  held_[job.id] = {job.tile, {{device, Stopwatch()}}};
  return job;
}

/// In a static split, others may only repeat a device's last tile.
bool TileQueue::may_repeat(const Held& held) const {
  if (plan_.lists.size() == 1) return true;
  const auto is_last = [&](const auto& holder) { return plan_.lists[holder.first].pixels() == 0; };
  return !plan_.exact && std::ranges::all_of(held.holders, is_last);
}

std::optional<TileJob> TileQueue::take_repeated(std::size_t device) {
  std::vector<HeldTile> tiles;
  std::vector<std::uint64_t> ids;
  for (const auto& [id, held] : held_) {
    if (pixel_count(held.tile) > devices_[device]->most_pixels || !may_repeat(held)) continue;
    tiles.push_back(as_held(held));
    ids.push_back(id);
  }
  const std::optional<std::size_t> chosen = tile_to_repeat(speeds_, device, tiles);
  if (!chosen) return std::nullopt;
  Held& held = held_[ids[*chosen]];
  held.holders[device] = Stopwatch();
  return TileJob{ids[*chosen], held.tile};
}

std::optional<TileJob> TileQueue::take(std::size_t device) {
  std::unique_lock lock(mutex_);
  devices_[device]->cancelled = false;
  while (!over() && !devices_[device]->retired) {
    find_stuck();
    if (auto job = take_waiting(device)) return job;
    if (auto job = take_repeated(device)) return job;
    changed_.wait_for(lock, between_tiles);
  }
  return std::nullopt;
}

void TileQueue::measure(std::size_t device, const Tile& tile, double seconds) {
  State& state = *devices_[device];
  const auto pixels = static_cast<double>(pixel_count(tile));
  // The first tile includes a driver's startup cost, so it is forgotten once there is a second.
  const bool second = state.work.pixels > 0 && state.recent_pixels == static_cast<double>(state.work.pixels);
  const double memory = second ? 0 : 0.5;
  state.recent_pixels = memory * state.recent_pixels + pixels;
  state.recent_seconds = memory * state.recent_seconds + seconds;
  speeds_[device].measured = state.recent_seconds > 0 ? state.recent_pixels / state.recent_seconds : 0;
  speeds_[device].sample = state.recent_pixels;
  state.work.pixels += pixel_count(tile);
  state.work.busy_seconds += seconds;
}

bool TileQueue::finished(std::size_t device, const TileJob& job, double seconds) {
  const std::lock_guard lock(mutex_);
  measure(device, job.tile, seconds);
  const auto found = held_.find(job.id);
  if (found == held_.end()) return false;
  for (const auto& [holder, clock] : found->second.holders)
    if (holder != device) devices_[holder]->cancelled = true;
  held_.erase(found);
  devices_[device]->work.kept_pixels += pixel_count(job.tile);
  unfinished_ -= pixel_count(job.tile);
  if (unfinished_ == 0) {
    for (auto& state : devices_)
      if (state->ready) state->work.ready_seconds = state->ready->seconds();
    changed_.notify_all();
  }
  return true;
}

bool TileQueue::given_up(std::size_t, const TileJob& job) {
  const std::lock_guard lock(mutex_);
  return held_.erase(job.id) > 0;
}

void TileQueue::release(std::size_t device, std::uint64_t id, bool give_back) {
  const auto found = held_.find(id);
  if (found == held_.end() || found->second.holders.erase(device) == 0) return;
  if (!found->second.holders.empty()) return;
  if (give_back) returned_.give_back(found->second.tile);
  held_.erase(found);
  changed_.notify_all();
}

void TileQueue::failed(std::size_t device, const TileJob& job) {
  const std::lock_guard lock(mutex_);
  release(device, job.id, true);
}

void TileQueue::halve(std::size_t device, const Tile& tile) {
  const std::lock_guard lock(mutex_);
  const std::uint64_t half = std::max<std::uint64_t>(pixel_count(tile) / 2, 1);
  devices_[device]->most_pixels = std::min(devices_[device]->most_pixels, half);
}

void TileQueue::retire(std::size_t device) {
  const std::lock_guard lock(mutex_);
  devices_[device]->retired = true;
  devices_[device]->cancelled = true;
  speeds_[device].working = false;
  speeds_[device].failed = true;
  std::vector<std::uint64_t> ids;
  for (const auto& [id, held] : held_) ids.push_back(id);
  for (const std::uint64_t id : ids) release(device, id, true);
  if (plan_.lists.size() > 1)
    while (const std::optional<Tile> tile = plan_.lists[device].take_whole()) returned_.give_back(*tile);
  changed_.notify_all();
}

void TileQueue::close() {
  const std::lock_guard lock(mutex_);
  closed_ = true;
  for (auto& state : devices_)
    if (state->ready) state->work.ready_seconds = state->ready->seconds();
  changed_.notify_all();
}

bool TileQueue::wait(double seconds) {
  std::unique_lock lock(mutex_);
  return changed_.wait_for(lock, std::chrono::duration<double>(seconds), [&] { return over(); });
}

bool TileQueue::complete() const {
  const std::lock_guard lock(mutex_);
  return unfinished_ == 0 && !more_;
}

DeviceWork TileQueue::work(std::size_t device) const {
  const std::lock_guard lock(mutex_);
  return devices_[device]->work;
}

}  // namespace sundog
