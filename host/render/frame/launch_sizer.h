// Divides a tile into launches: pixels, samples and work-group size of each, and reductions after failures.
// Pure arithmetic; others run and time the launches.
#pragma once
#include <optional>
#include <string>

#include "device/device.h"
#include "render/film/film.h"
#include "render/values/tuning.h"
#include "shared/launch.h"

namespace sundog {

/// Limits of a device and its kernels.
struct LaunchLimits {
  DeviceClass device_class = DeviceClass::cpu;
  unsigned compute_units = 1;
  unsigned tile_w = 4, tile_h = 4;  // pixels per work-item
  std::size_t most_group = 0;       // work-items per group; 0: unknown
  unsigned most_run = 1;            // items that a work-item can process in turn
};

/// The cause of a failed launch.
enum class LaunchFailure {
  group_too_large,   // too large for the kernel's registers or stack
  out_of_resources,  // a smaller group or launch may fit
  loops_cut_short    // the driver ended loops early: fewer samples may stay within its limit
};

/// A launch and its work-items.
struct SizedLaunch {
  Launch launch{};
  LaunchSize size;
  std::size_t samples = 0;      // pixels times samples
  double expected_seconds = 0;  // by earlier launches; 0: unknown
};

class LaunchSizer {
 public:
  /// `fields`: starts with small launches, because a field's samples may take a thousand times as long.
  LaunchSizer(const LaunchLimits& limits, const WorkGroup& asked, const Tuning& tuning, bool fields);

  /// Changes the work-group. Measured launch times are kept.
  void ask_for(const WorkGroup& group);
  /// Returns to short launches, because the next scene may cost more.
  void calm();
  /// Starts or restarts a tile.
  void begin(const Tile& tile, unsigned samples);
  /// The next launch of the tile; nothing when all samples are done. The samples of a pixel are taken in
  /// order, so dividing them among launches changes no bit.
  std::optional<SizedLaunch> next();
  /// Reports the time of the launch from next(); later launches aim at the target time.
  void note_time(double seconds);
  /// Rows of the tile with all samples.
  unsigned finished_rows() const;

  /// The launch size of the AOV kernel for this many pixels.
  LaunchSize surfaces(std::size_t pixels);

  /// Reduces the load: smaller groups, then smaller launches, then fewer samples at a time. Returns a
  /// description that starts with `why`; nothing if no reduction is left.
  std::optional<std::string> ask_less(LaunchFailure failure, const std::string& why);

  std::size_t most_group() const { return most_group_; }
  /// Maximum samples of any launch of the tile.
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
  // The current tile.
  Tile tile_{};
  unsigned samples_ = 0, columns_ = 0, rows_ = 0, row_height_ = 1, step_ = 1;
  unsigned item_ = 0, items_ = 0, sample_ = 0;  // next launch: first work-item, their number, first sample
  bool grid_ = false;                           // two-dimensional groups
  std::size_t least_size_ = 0;                  // minimum pixel-samples of a launch
  // The last launch.
  std::size_t last_size_ = 0,
              last_group_ = 0;  // pixel-samples; work-items of a group, 0: the driver's choice
  unsigned last_samples_ = 0;
  // Current targets and limits.
  std::size_t next_size_;                         // pixel-samples of the next launch
  std::size_t most_size_ = std::size_t{1} << 30;  // reduced when the device ran out of resources
  std::size_t most_group_;
  unsigned most_samples_ = ~0u;  // per launch; reduced when the driver ended loops early
  bool alone_ = false;           // work-groups of one
  double sample_seconds_ = 0;    // per pixel-sample, by the last launch; 0: unknown
};

}  // namespace sundog
