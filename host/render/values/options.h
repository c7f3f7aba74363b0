// How a frame is to be rendered.
#pragma once
#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "device/devices.h"
#include "render/values/tile.h"
#include "render/values/tuning.h"

namespace sundog {

class Faults;
struct Film;

/// How tiles are shared among devices: by measured speed as they come, or in fixed parts, one a device.
struct Split {
  enum class Kind { dynamic, fixed } kind = Kind::dynamic;
  std::vector<double> shares;  // of a fixed split; empty: by the devices' estimates
};

/// The kernels that a scene is drawn with: its own; its own, but others that draw the same bits may stand in
/// while they are built; always general ones, which most scenes share, so that few are built; or drafts,
/// which nearly all share, and which round otherwise.
enum class KernelChoice { own, own_when_built, general, draft };

/// Part `index` (from 1) of `count`.
struct PartOfFrame {
  int index = 1, count = 1;
};

struct RenderProgress {
  std::uint64_t pixels_done = 0, pixels_total = 0;
  double seconds = 0;
};

struct RenderOptions {
  WorkGroup work_group;
  std::function<Tuning(const DeviceInfo&)> tuning;  // of each device; empty: the defaults
  KernelChoice kernels = KernelChoice::own;
  int tile = 0;  // tile edge in pixels, rounded up to a multiple of 4; 0: chosen by measured speed
  Split split;
  PartOfFrame part;               // what to render of the frame
  std::optional<Tile> region;     // of the picture, which is all of the frame then; none: the whole
  std::vector<std::string> aovs;  // of aov_names()
  bool passes = false;            // samples double pass by pass, even where the scene asks for all at once
  int channels = 4;  // of the result's image; 3: without coverage; 0: neither it nor AOVs are made
  std::filesystem::path resume;      // a checkpoint: read when it exists
  std::filesystem::path checkpoint;  // written on interrupt and on the way, and removed by the caller; empty:
                                     // that is `resume`
  bool renews_checkpoint = false;    // one that is of another frame, or damaged, is left unread
  double checkpoint_seconds = 60;    // between those written on the way
  std::shared_ptr<Faults> faults;    // of checkpoints
  std::atomic<bool>* keep_now = nullptr;        // set: write one at once, and take this back
  bool in_haste = false;                        // when stopped, a moment more may be too long
  double time_limit = 0;                        // seconds, after which the film so far is returned; 0: none
  double noise = 0;                             // a frame in passes ends below this mean error
  std::function<void(const Film&)> on_picture;  // the film so far, every `picture_seconds`
  double picture_seconds = 0;
  std::function<void(const RenderProgress&)> on_progress;  // called by one thread at a time
  const std::atomic<bool>* stop = nullptr;                 // set: finish what runs, return the film so far
  bool keep_failed =
      false;  // when every device failed, return the film so far and the failure instead of throwing it
};

}  // namespace sundog
