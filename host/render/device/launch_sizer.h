// How a tile is cut into launches: how many pixels and samples each makes, in which work-groups, and what is
// asked for after a failure. Arithmetic that knows no device: launches are timed and run by others.
#pragma once
#include <optional>
#include <string>

#include "device/device.h"
#include "render/film/film.h"
#include "render/values/tuning.h"
#include "shared/launch.h"

namespace sundog {

/// What a device and its kernels allow.
struct LaunchLimits {
  DeviceClass device_class = DeviceClass::cpu;
  unsigned compute_units = 1;
  unsigned tile_w = 4, tile_h = 4;  // pixels a work-item
  std::size_t most_group = 0;       // work-items of a group; 0: not known
  unsigned most_run = 1;            // items that a work-item can take, one after another
};

/// How a launch failed.
enum class LaunchFailure {
  group_too_large,   // for the kernel's registers or stack
  out_of_resources,  // a smaller group or launch may fit
  loops_cut_short    // the driver ended loops before their end: fewer samples may be within its limit
};

/// A launch, and the work-items that it is enqueued with.
struct SizedLaunch {
  Launch launch{};
  LaunchSize size;
  std::size_t samples = 0;      // pixels times samples
  double expected_seconds = 0;  // by the launches before; 0: nothing is known
};

class LaunchSizer {
 public:
  /// `fields`: launches begin small, since a field's sample may take a thousand times as long as others.
  LaunchSizer(const LaunchLimits& limits, const WorkGroup& asked, const Tuning& tuning, bool fields);

  /// Changes the work-group. Measured launch times are kept.
  void ask_for(const WorkGroup& group);
  /// Starts with short launches again, because the next work may cost more.
  void calm();
  /// Begins a tile, or begins it again.
  void begin(const Tile& tile, unsigned samples);
  /// The next launch of the tile; nothing when all its samples are made. Samples of a pixel follow each
  /// other, so where they are cut changes no bit.
  std::optional<SizedLaunch> next();
  /// What the launch took that next() gave last: the following ones take about the wanted time.
  void note_time(double seconds);
  /// Rows of the tile's pixels that have all their samples.
  unsigned finished_rows() const;

  /// The launch of the kernel that makes the AOVs of so many pixels.
  LaunchSize surfaces(std::size_t pixels);

  /// Asks for less from now on: smaller groups, then smaller launches, fewer samples at a time. Returns what
  /// is asked for, in words that begin with `why`; nothing when there is nothing less.
  std::optional<std::string> ask_less(LaunchFailure failure, const std::string& why);

  std::size_t most_group() const { return most_group_; }
  /// The most samples of any launch of the tile.
  unsigned tile_samples() const { return last_samples_; }

 private:
  const WorkGroup& work_group() const;
  LaunchSize group_items(std::size_t columns, std::size_t rows) const;
  LaunchSize within_limits(LaunchSize size) const;
  std::optional<std::string> shrink_group(const std::string& why, std::size_t least);
  std::optional<std::string> shrink_launch(const std::string& why);
  std::optional<std::string> fewer_samples(const std::string& why);

  LaunchLimits limits_;
  WorkGroup asked_;
  Tuning tuning_;
  // The tile in hand.
  Tile tile_{};
  unsigned samples_ = 0, columns_ = 0, rows_ = 0, row_height_ = 1, step_ = 1;
  unsigned item_ = 0, items_ = 0, sample_ = 0;  // of the next launch: first work-item, how many, first sample
  bool grid_ = false;                           // groups of two dimensions
  std::size_t least_size_ = 0;                  // pixel-samples of any launch
  // The last launch.
  std::size_t last_size_ = 0,
              last_group_ = 0;  // pixel-samples; work-items of a group, 0: the driver's choice
  unsigned last_samples_ = 0;
  // What is asked for.
  std::size_t next_size_;                         // pixel-samples of the next launch
  std::size_t most_size_ = std::size_t{1} << 30;  // less where the device ran out of resources
  std::size_t most_group_;
  unsigned most_samples_ = ~0u;  // of a launch; less where the driver ended loops early
  bool alone_ = false;           // work-groups of one
  double sample_seconds_ = 0;    // a pixel-sample's, by the last launch; 0: not known
};

}  // namespace sundog
