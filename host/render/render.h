// The frame: plan the tiles, let every device take from the queue, gather the film and the figures.
#pragma once
#include <array>
#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "base/image.h"
#include "compile/compiled_scene.h"
#include "device/device.h"

namespace sundog {

/// Local size of the render kernels: the default one, the driver's own choice, or the user's.
struct WorkGroup {
  enum class Kind { automatic, driver, fixed } kind = Kind::automatic;
  std::size_t x = 64, y = 1;
};

struct RenderProgress {
  std::uint64_t pixels_done = 0, pixels_total = 0;
  double seconds = 0;
};

struct RenderOptions {
  WorkGroup work_group;
  int tile = 0;                   // tile edge in pixels, rounded up to a multiple of 4; 0: chosen
  std::vector<std::string> aovs;  // of aov_names()
  std::filesystem::path resume;   // checkpoint: read when it exists, written on interrupt; the caller removes it
  std::function<void(const RenderProgress&)> on_progress;  // called by one thread at a time
  const std::atomic<bool>* stop = nullptr;                 // set: finish what runs, return what there is
};

/// Sums over the frame, in the order of the COUNT_* constants.
using RayCounts = std::array<std::uint64_t, COUNTERS>;

struct DeviceReport {
  DeviceInfo info;
  std::uint64_t tiles = 0, failures = 0;
  double busy_seconds = 0;
  bool retired = false;
  std::vector<std::string> messages;
  std::map<std::string, KernelTimes> kernels;
  bool kernels_cached = false;
};

/// Wall seconds on the frame's clock; what overlaps is charged once.
struct RenderTimes {
  double build_kernels = 0, upload = 0, render = 0, readback = 0;
  bool cached = false;  // every program came from the cache
};

struct RenderResult {
  Image image;  // linear RGBA; alpha is coverage: 0 where only background was seen or nothing was rendered
  AovImages aovs;
  bool complete = true;  // false: stopped before the end
  RayCounts counts{};
  std::vector<DeviceReport> devices;
  RenderTimes times;
};

/// The AOVs `render` can make: depth, normal, position, albedo, object, material.
const std::vector<std::string>& aov_names();

/// Renders on all `devices` at once. Throws DeviceError when every device failed, BuildError when the kernels
/// build on none, IoError for an unreadable checkpoint, UsageError for a checkpoint of another scene or
/// unknown AOVs.
RenderResult render(const CompiledScene& scene, const std::vector<DeviceInfo>& devices,
                    const RenderOptions& options = {});

}  // namespace sundog
