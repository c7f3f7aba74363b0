// The interface of workers, which render tiles on a device of this process, in a worker process, or on
// another machine.
#pragma once
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "compile/compiled_scene.h"
#include "render/film/film.h"
#include "render/values/options.h"
#include "render/values/report.h"

namespace sundog {

/// A tile of a pass to be rendered, and its pixels' earlier samples, to which more are added; empty: none.
/// The AOVs are there if `surfaces` includes sums over samples.
struct TileRequest : Samples {
  Tile tile;
  std::vector<u32> pixels;  // image pixel of each tile pixel (Pass::pixels); empty: the tile's own
  u32 first_sample = 0, sample_count = 0;  // samples to add
  bool surfaces = false;                   // also render AOVs
  bool costs = false;                      // count rays, at least per work-item
};

/// A tile's pixels and ray counts. `tile` is the finished part: fewer rows than requested if rendering was
/// stopped. With `costs`, `rays` may have all of a group's rays at one pixel.
struct TileResult : Samples {
  Tile tile;
  RayCounts counts{};
};

/// A worker is used by one thread; overdue() and compiles() may be called by any.
class DeviceWorker {
 public:
  virtual ~DeviceWorker() = default;
  virtual const DeviceInfo& info() const = 0;
  /// Builds the kernels and uploads the scene. Called again after a failure, to start afresh. Throws
  /// DeviceError, BuildError.
  virtual RenderTimes open() = 0;
  /// Renders the requested tile. Throws DeviceError; then the worker must be opened again.
  virtual TileResult render(const TileRequest& request, const StopFlags& flags) = 0;
  virtual WorkerFigures figures() const = 0;
  /// Writes compiled kernels to the cache and stays open.
  virtual void keep_programs() {}
  /// Releases the device, and keeps its compiled kernels for the next time.
  virtual void close() = 0;
  /// Seconds that a launch has been running if it exceeds its limit, because the driver hangs; otherwise 0.
  virtual double overdue() const { return 0; }
  /// Whether a kernel's first launch is running, in which the driver may compile for a long time.
  virtual bool compiles() const { return false; }
  /// Called before open(): use only time that nothing else needs.
  virtual void be_nice() {}
  /// The worker is given up after this many failures.
  virtual unsigned failures_allowed() const { return 3; }
  /// Identifies the cores that it runs on (DeviceSpeed::processor).
  virtual int processor() const { return info().shares_cores() ? 0 : -1; }
};

/// A worker that stays open from one scene to the next.
class SceneWorker : public DeviceWorker {
 public:
  /// Sets the scene for the next open(), which reuses everything that still fits. Resets the figures.
  /// `options` must outlive their use.
  virtual void show(std::shared_ptr<const CompiledScene> scene, const RenderOptions& options) = 0;
  /// Prepares an open worker for requests with surfaces. Throws BuildError.
  virtual void prepare_surfaces() = 0;
  /// Whether it was opened and nothing has failed since.
  virtual bool is_open() const = 0;
  /// Makes open() throw DeviceError instead of waiting for a compiler, until the next show(). Any thread may
  /// call it.
  virtual void hurry() {}
  /// draws_draft(): whether the open scene is a draft, which rounds differently from the final picture and
  /// must be redrawn; any thread may call it. may_end_draft(): whether the kernels for redrawing are built
  /// (or cannot be built, which the next open() reports).
  virtual bool draws_draft() const { return false; }
  virtual bool may_end_draft() const { return false; }
  /// Called when nothing has to be drawn. The worker may prepare later work, as long as it delays none.
  virtual void rest() {}
  /// Kernels being built in the background. Any thread may call it.
  virtual std::size_t kernels_waiting() const { return 0; }
};

}  // namespace sundog
