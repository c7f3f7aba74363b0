// RenderSession: devices that stay open and draw successive scenes, always the newest. start() never waits;
// snapshot() shows the picture so far: first coarse pixels, then all, then more samples each, until it equals
// render()'s picture bit for bit.
//
// Thread-safe. Owns one thread per device and one that compiles scenes, recompiling only the parts that
// changed (compile/scene_compiler.h).
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/image.h"
#include "compile/scene_compiler.h"
#include "render/frame/result.h"
#include "scene/description.h"

namespace sundog {

/// Number of a start(), from 1.
using Generation = std::uint64_t;

/// Settings of a start() in addition to the scene's (size, samples, sampling, tracer). None changes a bit of
/// the final picture.
struct SessionSettings {
  bool coarse = true;  // if the picture takes longer, start with coarse pixels, then ever finer ones
  /// Seconds granted to a scene's first full picture before a newer start() replaces it; otherwise no scene
  /// of a quick succession (a drag) would be seen.
  double patience = 0.15;
  WorkGroup work_group;
  std::function<Tuning(const DeviceInfo&)> tuning;  // per device; empty: the defaults
  Split split;
  int tile = 0;  // as RenderOptions::tile
  /// Builds kernels in the background: while an edit's own kernels are built, general ones draw, which are
  /// built while the session rests. If false, an edit that needs a compiler waits for it, and no other
  /// kernels are built.
  bool general_kernels = true;
  bool light_groups = false;  // keeps the light of groups apart (path tracer), for set_balance()
};

enum class SessionState {
  idle,       // nothing has been started
  compiling,  // compiling the scene's tables
  preparing,  // building kernels or uploading tables; no pixel yet
  drawing,    // rendering pixels
  settled,    // the picture is complete
  stopped,    // cancel() ended it
  failed      // see `error`
};

/// Text for users: "compiling the scene", "building a kernel", "drawing"...
std::string state_text(SessionState state);

/// One device's work on the generation shown.
struct DeviceActivity : DeviceReport {
  std::string doing;  // "drawing", "building a kernel", "waiting", "out: ..." with the reason
};

/// The cost of an edit, for this generation. A camera edit recompiles no BVH or geometry.
struct EditWork {
  CompileWork compiled;                                   // parts of the scene that were compiled
  std::uint64_t tables_uploaded = 0, bytes_uploaded = 0;  // on all devices
  std::uint64_t kernels_built = 0;                        // by drivers' compilers
};

/// Seconds since start(); negative: not yet.
struct SessionTimes {
  double compiled = -1;  // the tables are compiled
  double ready = -1;     // the first device has kernels and tables
  double first = -1;     // the first full picture, coarse or not
  double full = -1;      // each pixel has its own sample
  double settled = -1;
};

/// The state of a session at one moment. A value, unaffected by later work.
struct Snapshot {
  Generation generation = 0;   // the newest that was started; 0: none
  Generation shown = 0;        // the generation of `picture`; older until the newest has a pixel; 0: none
  std::uint64_t revision = 0;  // grows with each change of any member
  SessionState state = SessionState::idle;
  std::string error;            // the compiler's or the last device's, if failed
  std::exception_ptr cause;     // the exception behind it
  unsigned pass = 0;            // complete passes of `shown`, including coarse ones
  unsigned samples = 0;         // minimum over the pixels; 0 while the picture is coarse
  unsigned wanted_samples = 0;  // the scene's
  unsigned block = 1;           // edge of the picture's blocks in pixels: 32 at most, 1 at full resolution
  double fraction = 0;          // samples taken / samples wanted
  /// Linear RGBA at the frame's size; alpha is coverage. Once settled, equal to render()'s image bit for bit.
  /// Coarse blocks have their pixel's colour. Shared and immutable; null before the first pixel.
  std::shared_ptr<const Image> picture;
  RayCounts counts{};  // the rays of `shown`, in the order of COUNT_* (shared/scene.h)
  double seconds = 0;  // since the start() of `shown`; once settled, its duration
  SessionTimes times;
  EditWork work;
  std::size_t kernels_waiting = 0;  // built in the background for later edits
  bool prepared = false;            // settled, and all those kernels are built
  bool draft = false;               // the picture will be redrawn by kernels that are being built
  std::vector<DeviceActivity> devices;
};

/// The surface at a pixel's centre.
struct Picked {
  std::shared_ptr<const SceneDescription> scene;  // the one that the pixel shows
  int object = -1;                                // index into its objects; -1: none
  int material = -1;                              // index into its materials; one past the end: the default
  dvec3 position{0}, normal{0};                   // in world space
  double depth = 0;                               // along the view; infinite if nothing is hit
};

/// Like state_text(now.state), but reports that a complete draft waits for a kernel.
std::string state_text(const Snapshot& now);

class SceneWorker;
struct LiveSession;

class RenderSession {
 public:
  /// Opens nothing: each device's thread opens it at the first start(). Throws DeviceError without devices.
  explicit RenderSession(const std::vector<DeviceInfo>& devices);
  /// For workers other than this process's devices.
  explicit RenderSession(const std::vector<std::shared_ptr<SceneWorker>>& workers);
  /// close()
  ~RenderSession();
  RenderSession(const RenderSession&) = delete;
  RenderSession& operator=(const RenderSession&) = delete;

  /// Draws this scene from now on. Returns at once. The previous scene is dropped at the end of its launches
  /// (about 50 ms), once it has a first picture or its patience is over; a scene still waiting for
  /// compilation is skipped. Errors of the scene or a device are reported as SessionState::failed. The scene
  /// must not change afterwards.
  Generation start(std::shared_ptr<const SceneDescription> scene, const SessionSettings& settings = {});

  /// Renders a frame to its end, replacing the current one, and waits: the picture of `sundog render`, with
  /// checkpoints, parts, AOVs and statistics. Meanwhile, snapshot() shows the previous picture. A concurrent
  /// start() or cancel() ends the frame early. Devices keep kernels and tables for the next frame. Throws
  /// like render() (render.h).
  RenderResult render(const std::shared_ptr<const CompiledScene>& scene, const RenderOptions& options = {});

  /// Multiplies the light of each group in snapshot()'s pictures: first the light in no group, then the
  /// groups by name (scene/light_groups.h); missing factors are 1. Redraws nothing. Affects scenes started
  /// with SessionSettings::light_groups, from their first full picture on.
  void set_balance(std::vector<glm::vec3> factors);

  /// Stops drawing and ends picks at once. The picture so far remains.
  void cancel();

  /// Stops drawing for good. Waits for launches (about 50 ms), but not for a driver that hangs or compiles.
  void close();

  /// Replaces the devices from the next start() on. Devices in both lists keep their kernels and tables.
  /// Throws DeviceError without devices.
  void use_devices(const std::vector<DeviceInfo>& devices);

  /// Takes microseconds without the picture.
  Snapshot snapshot(bool with_picture = true) const;

  /// Waits until the newest generation is settled, stopped or failed.
  void wait() const;
  /// Like wait(), but for at most `seconds`; returns false on timeout.
  bool wait_for(double seconds) const;
  /// Waits until Snapshot::revision differs from `revision`, for at most `seconds`; returns false on timeout.
  bool wait_for_change(std::uint64_t revision, double seconds) const;

  /// Waits for the surface that the newest generation shows at a pixel, found by one ray between two
  /// launches. Returns nothing outside the frame, without a scene that the devices have opened, or if
  /// cancel() or a newer scene ends it. The first pick in a kind of scene builds a kernel (seconds). Throws
  /// DeviceError, BuildError.
  std::optional<Picked> pick(int x, int y);

 private:
  std::shared_ptr<LiveSession> live_;
};

}  // namespace sundog
