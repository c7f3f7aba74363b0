// Each launch's time determines the next launch's size, aiming at 50 ms; failures permanently reduce samples,
// work-groups or sizes.
#include "render/frame/launch_sizer.h"

#include <fmt/format.h>

#include <algorithm>

#include "render/plan/tiles.h"

namespace sundog {
namespace {

// Seconds: short enough for a watchdog and for Ctrl-C, long compared with the overhead of some microseconds.
constexpr double launch_seconds = 0.05;
// Minimum work-items per compute unit and launch, so that units finish together.
constexpr unsigned unit_work_items = 16;
// Initial pixel-samples; samples of fields may take a thousand times as long.
constexpr std::size_t first_launch_size = 4096, first_launch_size_of_fields = 512;
// Launches grow in a fast sky. On a CPU, launches of this size among slow fields behind it do not yet look
// like a hang.
constexpr std::size_t most_launch_size_of_fields = 65536;

// Groups larger than this may be the reason when resources run out.
constexpr std::size_t small_group = 64;

unsigned divide_up(unsigned a, unsigned b) { return (a + b - 1) / b; }

}  // namespace

LaunchSizer::LaunchSizer(const LaunchLimits& limits, const WorkGroup& asked, const Tuning& tuning,
                         bool fields)
    : limits_(limits),
      asked_(asked),
      tuning_(tuning),
      next_size_(fields ? first_launch_size_of_fields : first_launch_size),
      most_group_(limits.most_group) {
  if (fields && limits_.device_class == DeviceClass::cpu) most_size_ = most_launch_size_of_fields;
  // The fastest group for a shallower scene may be too large for this one.
  if (most_group_ > 0 && tuning_.work_group.x * tuning_.work_group.y > most_group_) tuning_.work_group = {};
  if (most_group_ > 0 && tuning_.surfaces_group.x > most_group_) tuning_.surfaces_group = {};
}

// The user's group, else the tuned group, else the default.
const WorkGroup& LaunchSizer::work_group() const {
  return asked_.kind == WorkGroup::Kind::automatic ? tuning_.work_group : asked_;
}

// Halves the longer side of a group until it is within the limit.
LaunchSize LaunchSizer::within_limits(LaunchSize size) const {
  while (most_group_ > 0 && size.local_x * size.local_y > most_group_) {
    std::size_t& side = size.local_x >= size.local_y ? size.local_x : size.local_y;
    side /= 2;
  }
  return size;
}

// Groups columns x rows work-items: a grid if the user requested a two-dimensional group, else one row.
LaunchSize LaunchSizer::group_items(std::size_t columns, std::size_t rows) const {
  const WorkGroup& group = work_group();
  const std::size_t items = columns * rows;
  if (group.kind == WorkGroup::Kind::driver) return {items, 1, 0, 0};
  if (group.kind == WorkGroup::Kind::fixed)
    return within_limits(group.y > 1 ? LaunchSize{columns, rows, group.x, group.y}
                                     : LaunchSize{items, 1, group.x, 1});
  if (alone_) return {items, 1, 1, 1};
  // One ray per lane needs a full group, or at least one that fills the driver's vectors. With many pixels
  // per work-item, groups of one cost nothing on PoCL, which hands them out 32 at a time and compiles for a
  // single size.
  std::size_t wanted = 64;
  if (limits_.device_class == DeviceClass::cpu) {
    const bool many_pixels = limits_.tile_w * limits_.tile_h > 1;
    const std::size_t share = items / (std::size_t{4} * std::max(1u, limits_.compute_units));
    wanted = many_pixels ? 1 : std::clamp<std::size_t>(share, 8, 64);
  }
  return within_limits({items, 1, wanted, 1});
}

void LaunchSizer::ask_for(const WorkGroup& group) {
  asked_ = group;
  most_group_ = limits_.most_group;
  alone_ = false;
}

void LaunchSizer::calm() {
  next_size_ = std::max<std::size_t>(next_size_ / 4, 1);
  sample_seconds_ = 0;
}

void LaunchSizer::begin(const Tile& tile, unsigned samples) {
  tile_ = tile;
  samples_ = samples;
  const unsigned width = static_cast<unsigned>(tile.width), height = static_cast<unsigned>(tile.height);
  const unsigned item_pixels = limits_.tile_w * limits_.tile_h;
  grid_ = work_group().kind == WorkGroup::Kind::fixed && work_group().y > 1;
  // A row of items covers tiles, or blocks of 8x4 pixels (lane_pixel() in lib/path/tile.cl).
  const bool blocks = item_pixels == 1 && !grid_;
  row_height_ = blocks ? 4 : limits_.tile_h;
  columns_ = blocks ? divide_up(width, 8) * 32 : divide_up(width, limits_.tile_w);
  rows_ = divide_up(height, row_height_);
  // A grid of groups takes whole rows of items; otherwise each unit should get an item.
  step_ = grid_ ? columns_ : std::clamp(limits_.compute_units, 1u, std::max(1u, columns_ * rows_));
  least_size_ = static_cast<std::size_t>(step_) * item_pixels;
  item_ = items_ = sample_ = 0;
  last_size_ = last_group_ = 0;
  last_samples_ = 0;
}

std::optional<SizedLaunch> LaunchSizer::next() {
  if (sample_ == samples_) item_ += items_, items_ = 0, sample_ = 0;
  const unsigned all = columns_ * rows_;
  if (item_ >= all || samples_ == 0) return std::nullopt;
  const std::size_t item_pixels = std::size_t{limits_.tile_w} * limits_.tile_h;
  if (items_ == 0)  // all samples of these items precede the next items
    items_ =
        static_cast<unsigned>(std::clamp<std::size_t>(next_size_ / least_size_ * step_, step_, all - item_));
  const std::size_t pixels = items_ * item_pixels;
  const unsigned most = std::min(samples_ - sample_, most_samples_);
  const unsigned count = static_cast<unsigned>(std::clamp<std::size_t>(next_size_ / pixels, 1, most));
  SizedLaunch sized;
  const unsigned share = items_ / (unit_work_items * std::max(1u, limits_.compute_units));
  const unsigned run = grid_ ? 1 : std::clamp(share, 1u, limits_.most_run);
  sized.size = grid_ ? group_items(columns_, items_ / columns_) : group_items(divide_up(items_, run), 1);
  sized.samples = pixels * count;
  sized.expected_seconds = sample_seconds_ * static_cast<double>(sized.samples);
  sized.launch = {static_cast<u32>(tile_.x),
                  static_cast<u32>(tile_.y),
                  static_cast<u32>(tile_.width),
                  static_cast<u32>(tile_.height),
                  item_,
                  item_ + items_,
                  static_cast<u32>(sized.size.x),
                  grid_ ? 0u : 1u,
                  sample_,
                  count,
                  0,
                  0,
                  run};
  sample_ += count;
  last_size_ = sized.samples;
  last_group_ = sized.size.local_x * sized.size.local_y;
  last_samples_ = std::max(last_samples_, count);
  return sized;
}

void LaunchSizer::note_time(double seconds) {
  const double target = tuning_.launch_ms > 0 ? tuning_.launch_ms * 1e-3 : launch_seconds;
  next_size_ = next_launch_size(last_size_, seconds, target, least_size_, most_size_);
  sample_seconds_ = seconds / static_cast<double>(last_size_);
}

unsigned LaunchSizer::finished_rows() const {
  const unsigned items = sample_ == samples_ ? item_ + items_ : item_;
  if (columns_ == 0) return 0;
  return std::min(items / columns_ * row_height_, static_cast<unsigned>(tile_.height));
}

LaunchSize LaunchSizer::surfaces(std::size_t pixels) {
  const bool tuned = tuning_.surfaces_group.kind == WorkGroup::Kind::fixed;
  const LaunchSize size =
      within_limits({divide_up(static_cast<unsigned>(pixels), limits_.tile_w * limits_.tile_h), 1,
                     tuned ? tuning_.surfaces_group.x : 16, 1});
  last_group_ = size.local_x;
  return size;
}

std::optional<std::string> LaunchSizer::shrink_launch(const std::string& why) {
  if (last_size_ <= least_size_) return std::nullopt;
  most_size_ = next_size_ = std::max(last_size_ / 2, least_size_);
  return fmt::format("{}: launches of at most {} pixel-samples from here on", why, most_size_);
}

// Applies only if the last group had more than `least` work-items.
std::optional<std::string> LaunchSizer::shrink_group(const std::string& why, std::size_t least) {
  if (last_group_ <= least) return std::nullopt;
  most_group_ = last_group_ / 2;
  return fmt::format("{}: work-groups of at most {} from here on", why, most_group_);
}

// As a last resort, gives each work-item its own group, so that no other shares its loops.
std::optional<std::string> LaunchSizer::fewer_samples(const std::string& why) {
  if (limits_.most_run > 1) {
    limits_.most_run = 1;
    return why + "; work-items of one tile of pixels from here on";
  }
  if (last_samples_ > 1) {
    most_samples_ = last_samples_ / 2;
    return fmt::format("{}; launches of at most {} samples a pixel from here on", why, most_samples_);
  }
  if (alone_ || last_group_ == 1 || asked_.kind != WorkGroup::Kind::automatic) return std::nullopt;
  alone_ = true;
  tuning_.work_group = {};
  return why + "; work-groups of one from here on";
}

std::optional<std::string> LaunchSizer::ask_less(LaunchFailure failure, const std::string& why) {
  if (failure == LaunchFailure::loops_cut_short) return fewer_samples(why);
  if (failure == LaunchFailure::group_too_large) return shrink_group(why, 1);
  if (auto note = shrink_group(why, small_group)) return note;
  if (auto note = shrink_launch(why)) return note;
  return shrink_group(why, 1);
}

}  // namespace sundog
