// Options of a render: devices' shares, tuning, region, outputs, checkpoint, limits, callbacks.
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

/// How tiles are shared among devices: on demand by measured speed, or in fixed parts, one per device.
struct Split {
  enum class Kind { dynamic, fixed } kind = Kind::dynamic;
  std::vector<double> shares;  // for a fixed split; empty: by the devices' estimates
};

/// The kernels that draw a scene. own: its own. own_when_built: its own, but until they are built others that
/// draw the same bits. general: shared by most scenes, so that few are built. draft: shared by nearly all
/// scenes, but they round differently.
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
  std::function<Tuning(const DeviceInfo&)> tuning;  // per device; empty: the defaults
  KernelChoice kernels = KernelChoice::own;
  int tile = 0;             // tile edge in pixels, rounded up to a multiple of 4; 0: chosen by measured speed
  double tile_seconds = 0;  // a tile takes at most this long; 0: as tuned
  Split split;
  PartOfFrame part;               // the part of the frame to render
  std::optional<Tile> region;     // renders only this region of the picture; none: all of it
  std::vector<std::string> aovs;  // names from aov_names()
  bool passes = false;            // double the samples pass by pass, even if the scene asks for all at once
  int channels = 4;               // the image's; 3: without alpha; 0: neither image nor AOVs are made
  std::filesystem::path resume;   // a checkpoint; read if it exists
  std::filesystem::path checkpoint;             // written regularly and on interrupt; the caller removes it;
                                                // empty: `resume`
  bool renews_checkpoint = false;               // a damaged checkpoint, or one of another frame, is ignored
  double checkpoint_seconds = 60;               // between checkpoints
  std::shared_ptr<Faults> faults;               // simulated when checkpoints are written
  std::atomic<bool>* keep_now = nullptr;        // set: write a checkpoint at once, and clear this
  bool in_haste = false;                        // when stopped, do not wait for drivers longer than necessary
  double time_limit = 0;                        // seconds until the film so far is returned; 0: none
  double noise = 0;                             // a frame in passes ends below this mean error; 0: never
  std::function<void(const Film&)> on_picture;  // the film so far, every `picture_seconds`
  double picture_seconds = 0;
  std::function<void(const RenderProgress&)> on_progress;  // called by one thread at a time
  const std::atomic<bool>* stop = nullptr;  // set: finish running launches and return the film so far
  bool keep_failed = false;  // if every device fails, return film and failure instead of throwing
};

}  // namespace sundog
