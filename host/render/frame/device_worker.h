// The interface of workers, which render tiles: on a device of this process, in a worker process, or on
// another machine.
#pragma once
#include <atomic>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "compile/compiled_scene.h"
#include "render/film/film.h"
#include "render/values/options.h"
#include "render/values/report.h"

namespace sundog {

/// The work of one tile of a pass.
struct TileRequest {
  Tile tile;
  std::vector<u32> pixels;                 // each pixel's of the image (Pass::pixels); empty: its own
  u32 first_sample = 0, sample_count = 0;  // samples to add to what follows
  bool surfaces = false;                   // AOVs
  bool costs = false;                      // rays, at least of each work-item's pixels together
  std::vector<float4> sums;                // of each pixel's earlier samples; empty: none
  std::vector<float> weights;
  std::vector<u32> rays;     // of each pixel so far, where they are counted
  std::vector<float4> aovs;  // of each pixel so far, where `surfaces` holds sums over samples
};

/// A tile's pixels and ray counts. `tile` is what was finished: less rows than asked for when it was stopped
/// on the way.
struct TileResult {
  Tile tile;
  std::vector<float4> sums;
  std::vector<float> weights;
  std::vector<float4> aovs;
  std::vector<u32> rays;  // of each pixel where they are counted, or with `costs` of groups at one of theirs
  RayCounts counts{};
};

/// Asked between launches: whether to return the finished part.
struct StopFlags {
  const std::atomic<bool>* stop = nullptr;       // the frame is over
  const std::atomic<bool>* cancelled = nullptr;  // another device has finished the tile
  bool set() const { return (stop && stop->load()) || (cancelled && cancelled->load()); }
};

/// A worker's statistics so far.
struct WorkerFigures {
  std::map<std::string, KernelTimes> kernels;
  double readback_seconds = 0;
  std::vector<std::string> notes;  // what did not stop it: smaller launches, a cache that could not be used
  std::uint64_t tables_uploaded = 0, bytes_uploaded = 0;
  std::uint64_t kernels_built = 0;  // programs, by the driver's compiler
};

/// Used by one thread, overdue() and compiles() by any.
class DeviceWorker {
 public:
  virtual ~DeviceWorker() = default;
  virtual const DeviceInfo& info() const = 0;
  /// Makes it ready: kernels built, scene uploaded. Called again after a failure, to begin afresh. Throws
  /// DeviceError, BuildError.
  virtual RenderTimes open() = 0;
  /// Makes what is asked for. Throws DeviceError; then it must be opened again.
  virtual TileResult render(const TileRequest& request, const StopFlags& flags) = 0;
  virtual WorkerFigures figures() const = 0;
  /// Writes compiled kernels to the cache and stays open.
  virtual void keep_programs() {}
  /// Lets go of the device, and keeps its compiled kernels for the next time.
  virtual void close() = 0;
  /// Seconds that a launch has run when it has passed its limit, else 0: the driver hangs.
  virtual double overdue() const { return 0; }
  /// Whether a kernel's first launch is in hand, in which its driver may compile for long.
  virtual bool compiles() const { return false; }
  /// Asked before open(): to use only time that nobody else wants.
  virtual void be_nice() {}
  /// After so many failures it is not tried again.
  virtual unsigned failures_allowed() const { return 3; }
  /// Which cores it runs on (DeviceSpeed::processor).
  virtual int processor() const { return info().shares_cores() ? 0 : -1; }
};

/// A worker that stays open from one scene to the next.
class SceneWorker : public DeviceWorker {
 public:
  /// From the next open() on: another scene, for which it keeps what suits it. Its figures begin anew.
  /// `options` must outlive their use.
  virtual void show(std::shared_ptr<const CompiledScene> scene, const RenderOptions& options) = 0;
  /// Makes it, while it is open, ready for requests that ask for surfaces. Throws BuildError.
  virtual void prepare_surfaces() = 0;
  /// It was opened, and nothing has failed since.
  virtual bool is_open() const = 0;
  /// Makes open() throw DeviceError instead of waiting for a compiler, until the next show(). Any thread may
  /// call it.
  virtual void hurry() {}
  /// Whether the open scene is a draft, which rounds otherwise than its picture and must be drawn anew, and
  /// whether the kernels for that are there (or cannot be built, which the next open() reports). Any thread
  /// may ask the first.
  virtual bool draws_draft() const { return false; }
  virtual bool may_end_draft() const { return false; }
  /// Nothing has to be drawn now. The worker may prepare for later work, as long as it delays none.
  virtual void rest() {}
  /// Kernels that are being built beside the work. Any thread.
  virtual std::size_t kernels_waiting() const { return 0; }
};

}  // namespace sundog
