// The frame: plan the tiles, let every device take from the queue, gather the film and the figures.
#pragma once
#include <array>
#include <atomic>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "base/image.h"
#include "compile/compiled_scene.h"
#include "device/device.h"
#include "device/device_pool.h"
#include "render/film.h"
#include "render/part.h"
#include "render/tuning.h"

namespace sundog {

/// How tiles are shared among devices: by measured speed as they come, or in fixed parts, one a device.
struct Split {
  enum class Kind { dynamic, fixed } kind = Kind::dynamic;
  std::vector<double> shares;  // of a fixed split; empty: by the devices' estimates
};

struct RenderProgress {
  std::uint64_t pixels_done = 0, pixels_total = 0;
  double seconds = 0;
};

struct RenderOptions {
  std::shared_ptr<DevicePool> pool;  // where devices wait between frames; none: opened for this one
  WorkGroup work_group;
  std::function<Tuning(const DeviceInfo&)> tuning;  // of each device; empty: the defaults
  int tile = 0;  // tile edge in pixels, rounded up to a multiple of 4; 0: chosen by measured speed
  Split split;
  PartOfFrame part;               // what to render of the frame
  std::vector<std::string> aovs;  // of aov_names()
  int channels = 4;  // of the result's image; 3: without coverage; 0: neither it nor AOVs are made
  std::filesystem::path resume;      // a checkpoint: read when it exists
  std::filesystem::path checkpoint;  // written on interrupt and on the way, and removed by the caller; empty:
                                     // that is `resume`
  double checkpoint_seconds = 60;    // between those written on the way
  std::atomic<bool>* keep_now = nullptr;                   // set: write one at once, and take this back
  bool in_haste = false;                                   // when stopped, a moment more may be too long
  std::function<void(const RenderProgress&)> on_progress;  // called by one thread at a time
  const std::atomic<bool>* stop = nullptr;                 // set: finish what runs, return what there is
  bool keep_failed = false;  // when every device failed, return what there is, and the failure, not throw it
};

/// Sums over the frame, in the order of the COUNT_* constants.
using RayCounts = std::array<std::uint64_t, COUNTERS>;

struct DeviceReport {
  DeviceInfo info;
  std::uint64_t tiles = 0, failures = 0;
  std::uint64_t pixels = 0;           // in the image from it
  std::uint64_t outrun = 0;           // tiles that another device finished sooner
  double busy_seconds = 0;            // on tiles that it finished
  double share = 0;                   // of the frame's pixels
  bool ready = false;                 // its kernels were built before the frame's end
  bool retired = false;               // it failed too often, or hangs
  bool abandoned = false;             // its driver still had not come back at the end
  std::vector<std::string> messages;  // its failures
  std::vector<std::string> notes;     // what it could live with
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
  double efficiency = 1;  // work done over what the devices could have done (plan.h)
  RenderTimes times;
  Film film;                     // what the image was developed from
  std::uint64_t key = 0;         // of the scene, for write_checkpoint; 0 without a checkpoint
  std::exception_ptr failure;    // every device failed: what the last one threw (options.keep_failed)
  bool checkpoint_kept = false;  // an interrupted frame is in the checkpoint
  std::string checkpoint_error;  // why it could not be written there
};

class TileServer;

/// What makes tiles, and what is known of it before it is opened.
struct ServerPlan {
  DeviceInfo info;
  int processor = -1;  // devices with the same number run on the same cores (plan.h)
  std::function<std::shared_ptr<TileServer>(const RenderOptions&)> make;
};

/// A device of this process.
ServerPlan plan_local(std::shared_ptr<const CompiledScene> scene, const DeviceInfo& device);

/// The AOVs `render` can make: depth, normal, position, albedo, object, material.
const std::vector<std::string>& aov_names();

/// Renders on all `devices` at once and waits for each of them to let go. Throws DeviceError when every
/// device failed, BuildError when the kernels build on none, SceneError for a damaged checkpoint, UsageError
/// for a checkpoint of another scene, unknown AOVs, or shares that do not fit the devices.
RenderResult render(const CompiledScene& scene, const std::vector<DeviceInfo>& devices,
                    const RenderOptions& options = {});

/// The same, but does not wait for a driver that compiles, or is in a launch, when the frame is finished: its
/// thread is left behind, holding the scene.
RenderResult render(std::shared_ptr<const CompiledScene> scene, const std::vector<DeviceInfo>& devices,
                    const RenderOptions& options = {});

/// The same on devices that may be other processes'.
RenderResult render(std::shared_ptr<const CompiledScene> scene, const std::vector<ServerPlan>& servers,
                    const RenderOptions& options = {});

/// Threads left behind in drivers. While there are any, a process should end by _exit(): what static
/// destructors and drivers' exit handlers take down is still in use.
unsigned threads_left_behind();

}  // namespace sundog
