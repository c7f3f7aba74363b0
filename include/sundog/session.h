// Devices that stay open and draw one scene after another, for editors and viewers.
#pragma once
#include <sundog/render.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace sundog {
inline namespace v0 {

/// The activity of a session.
enum class SessionState {
  idle,       ///< nothing has been started
  compiling,  ///< compiling the scene's tables
  preparing,  ///< building kernels or uploading tables
  drawing,    ///< rendering pixels
  settled,    ///< the picture is complete
  stopped,    ///< Session::cancel() ended it
  failed      ///< Snapshot::error gives the reason
};

/// Options of Session::start(). None changes a bit of the settled picture.
struct SessionOptions {
  bool coarse = true;      ///< show coarse pixels first if the picture takes longer
  double patience = 0.15;  ///< seconds granted to a scene's first picture before a newer scene replaces it
  WorkGroup work_group{};  ///< work-group size of the kernels
  int tile = 0;            ///< edge in pixels; 0: chosen by measured speed
};

/// The state of a session at one moment.
struct Snapshot {
  std::uint64_t generation = 0;             ///< the newest Session::start()
  std::uint64_t shown = 0;                  ///< the generation that `picture` shows; 0: none yet
  std::uint64_t revision = 0;               ///< grows with each change of any member
  SessionState state = SessionState::idle;  ///< state of the newest start()
  std::string error{};                      ///< why a start() failed; else empty
  double fraction = 0;                      ///< fraction of the samples that are done, 0..1
  unsigned samples = 0;                     ///< minimum over the pixels; 0 while the picture is coarse
  unsigned block = 1;  ///< edge in pixels of the blocks in a coarse picture; 1: full resolution
  double seconds = 0;  ///< since the start() of `shown`; once settled, its duration
  Image picture{};     ///< linear RGBA at the scene's size; empty at first
};

/// The surface seen at a pixel's centre.
struct Pick {
  std::string object{};    ///< its name; empty: nothing hit, or unnamed
  std::string material{};  ///< its name; empty: nothing hit, or unnamed
  Vec3 position{};         ///< in world space
  Vec3 normal{};           ///< unit length, in world space
  double depth = 0;        ///< along the view; infinite if nothing is hit
};

/// Draws the newest scene in the background, with a thread per device and a compiling thread. Thread-safe.
class SUNDOG_API Session {
 public:
  /// Opens `devices`; empty: the device estimated fastest. Throws Error (device).
  explicit Session(const std::vector<Device>& devices = {});
  /// Stops drawing and waits for running launches (about 50 ms). A driver that hangs or compiles keeps its
  /// thread, which belongs to the devices, or to the process if the session chose them.
  ~Session();
  Session(Session&&) noexcept;             ///< afterwards `other` can only be destroyed or assigned to
  Session& operator=(Session&&) noexcept;  ///< stops what this session draws

  /// Draws the scene as it is now, replacing the previous scene. Returns its generation once the scene is
  /// read; snapshot() then gives the picture. Only changed parts are compiled again. Throws Error (scene;
  /// internal for a frame that exceeds the memory); the previous scene then stays.
  std::uint64_t start(const Scene& scene, const SessionOptions& options = {});
  /// Stops drawing and ends calls of pick(); the picture so far remains.
  void cancel();
  /// Takes effect at the next start(). Throws Error (device).
  void use_devices(const std::vector<Device>& devices);

  /// Returns the current state; microseconds without the picture.
  Snapshot snapshot(bool with_picture = true) const;
  /// Waits until the newest generation is settled, stopped or failed.
  void wait() const;
  /// Like wait(), for at most `seconds`; returns false on timeout.
  bool wait_for(double seconds) const;
  /// Waits until Snapshot::revision differs from `revision`, for at most `seconds`; returns false on timeout.
  bool wait_for_change(std::uint64_t revision, double seconds) const;
  /// Waits, then returns the picture, equal to render()'s to the bit. Throws the Error that ended the
  /// drawing.
  Image finish() const;

  /// Returns the surface that a pixel shows, by casting one ray. Empty outside the frame, without a scene
  /// that the devices have opened, or when cancel() is called or a newer scene arrives. The first call may
  /// build a kernel (seconds). Throws Error: device, build.
  std::optional<Pick> pick(int x, int y);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace v0
}  // namespace sundog
