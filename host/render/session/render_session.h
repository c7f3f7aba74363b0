// RenderSession: devices that stay open and draw one scene after the other, the newest at once. start() never
// waits; snapshot() shows the picture so far: coarse pixels first, then all, then more samples of each, until
// it has the bits of render().
//
// A session is used by any number of threads. Its own are one a device, and one that compiles scenes, only
// the parts of them that differ from the scene before (compile/scene_compiler.h).
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

/// Counts from 1; each start() has the next.
using Generation = std::uint64_t;

/// What a start() asks for beside the scene, whose own settings hold (size, samples, sampling, tracer). None
/// of it changes a bit of the settled picture.
struct SessionSettings {
  bool coarse = true;  // while the picture would take longer, pixels 8 apart come first, then 4, then 2
  /// Seconds that its first picture of the whole frame is given when a newer start() comes: without, scenes
  /// that follow each other fast (a drag) would all be dropped before anything is seen of them.
  double patience = 0.15;
  WorkGroup work_group;
  std::function<Tuning(const DeviceInfo&)> tuning;  // of each device; empty: the defaults
  Split split;
  int tile = 0;  // as RenderOptions::tile
  /// Kernels are built beside the drawing, general ones while the session rests, which draw while an edit's
  /// own are built. Without, an edit that needs a compiler waits for it, and nothing is built that no edit
  /// asked for.
  bool general_kernels = true;
};

enum class SessionState {
  idle,       // nothing was started
  compiling,  // the scene's tables are being made
  preparing,  // kernels are being built, or tables uploaded; there is no pixel yet
  drawing,    // pixels come
  settled,    // the picture is complete
  stopped,    // cancel() ended it
  failed      // `error` says why
};

/// Plain words for people: "compiling the scene", "building a kernel", "drawing"...
std::string state_text(SessionState state);

/// One device in the generation that is shown.
struct DeviceActivity {
  DeviceInfo info;
  std::string doing;  // "drawing", "building a kernel", "uploading", "waiting", "out: ..." with the reason
  std::uint64_t tiles = 0, pixels = 0;         // made for this generation, pixels of each pass counted
  double share = 0;                            // of the pixels of all devices, 0..1
  double busy_seconds = 0;                     // on tiles
  std::map<std::string, KernelTimes> kernels;  // of this generation
  std::vector<std::string> messages;           // its failures
  std::vector<std::string> notes;              // what it could live with
};

/// What an edit cost, for this generation. A camera's edit has no BVH and no geometry here.
struct EditWork {
  CompileWork compiled;                                   // parts of the scene that were made, not kept
  std::uint64_t tables_uploaded = 0, bytes_uploaded = 0;  // on all devices
  std::uint64_t kernels_built = 0;                        // by a driver's compiler
};

/// Seconds since start(); below 0: not yet.
struct SessionTimes {
  double compiled = -1;  // the tables are made
  double ready = -1;     // the first device has kernels and tables
  double first = -1;     // a picture of the whole frame is there, coarse or not
  double full = -1;      // each pixel has a sample of its own
  double settled = -1;
};

/// The session at one moment. A value: later work of the session does not change it.
struct Snapshot {
  Generation generation = 0;   // the newest that was started; 0: none
  Generation shown = 0;        // whose picture this is: an older one's until the newest has a pixel; 0: none
  std::uint64_t revision = 0;  // grows with each change of anything here
  SessionState state = SessionState::idle;
  std::string error;            // state failed: what compile() or the last device threw
  unsigned pass = 0;            // passes of `shown` that are complete, the coarse ones among them
  unsigned samples = 0;         // that each pixel has at least; 0 while the picture is coarse
  unsigned wanted_samples = 0;  // of the scene
  unsigned block = 1;           // edge in pixels of the blocks that the picture is made of: 8, 4, 2, 1
  double fraction = 0;          // of the work: samples taken over all that are wanted
  /// Linear RGBA of the frame's size; alpha is coverage. Settled: the image of render() to the bit. Coarse
  /// blocks are filled with their pixel. Shared and immutable; null before the first pixel.
  std::shared_ptr<const Image> picture;
  RayCounts counts{};  // of `shown`, in the order of COUNT_* (shared/scene.h)
  double seconds = 0;  // since the start() of `shown`, or the time it took
  SessionTimes times;
  EditWork work;
  std::size_t kernels_waiting = 0;  // that are built beside the drawing, for edits to come
  bool prepared = false;            // settled, and none of these is left to build
  bool draft = false;               // what is drawn will be drawn anew, by kernels that are being built
  std::vector<DeviceActivity> devices;
};

/// What a pixel's centre shows.
struct Picked {
  int object = -1;               // index into SceneDescription::objects; -1: nothing
  int material = -1;             // index into SceneDescription::materials, or behind them the default one
  dvec3 position{0}, normal{0};  // in the world
  double depth = 0;              // along the view; infinite where nothing is
};

/// The same words, but that a draft that is complete waits for a kernel.
std::string state_text(const Snapshot& now);

class SceneServer;
struct Frame;

class RenderSession {
 public:
  /// Opens nothing yet: a device is opened by its own thread at the first start(). Throws DeviceError without
  /// any.
  explicit RenderSession(const std::vector<DeviceInfo>& devices);
  /// The same of other servers than this process's devices.
  explicit RenderSession(std::vector<std::shared_ptr<SceneServer>> servers);
  /// Ends what is in hand: waits for launches (about 50 ms), not for a driver that hangs or compiles.
  ~RenderSession();
  RenderSession(const RenderSession&) = delete;
  RenderSession& operator=(const RenderSession&) = delete;

  /// Draws this scene from now on. Returns at once; what was in hand is dropped at the end of its launches
  /// (about 50 ms) as soon as it has a first picture or its patience is over, and what was waiting to be
  /// compiled never is. Errors of the scene or a device come as
  /// SessionState::failed. The scene must not be changed afterwards.
  Generation start(std::shared_ptr<const SceneDescription> scene, const SessionSettings& settings = {});

  /// Renders a frame to its end, in place of what is drawn, and waits for it: `sundog render`'s picture, with
  /// checkpoints, parts, AOVs and figures. Nobody else sees it: snapshot() shows what was drawn before. A
  /// start() or cancel() meanwhile ends it before its time. Devices keep what suits the next one. Throws as
  /// render() does (render.h).
  RenderResult render(const std::shared_ptr<const CompiledScene>& scene, const RenderOptions& options = {});

  /// Stops drawing at once. The picture so far stays.
  void cancel();

  /// From the next start() on. Devices that stay keep their kernels and tables. Throws DeviceError without
  /// any.
  void use_devices(const std::vector<DeviceInfo>& devices);

  /// With `with_picture` false it has none, and takes microseconds.
  Snapshot snapshot(bool with_picture = true) const;

  /// Waits until the newest generation is settled, stopped or failed.
  void wait() const;
  /// The same for at most so long; whether it is.
  bool wait_for(double seconds) const;
  /// Waits until Snapshot::revision differs from `revision`, at most so long; whether it does.
  bool wait_for_change(std::uint64_t revision, double seconds) const;

  /// What the newest generation shows at a pixel, by one ray of a device, between two launches; waits for it.
  /// Nothing outside the frame, without a scene, or when it is replaced by a newer one meanwhile. The first
  /// pick of a kind of scene builds a kernel (seconds). Throws DeviceError, BuildError.
  std::optional<Picked> pick(int x, int y);

 private:
  friend void run_frame(const std::shared_ptr<Frame>& frame, bool wait);
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace sundog
