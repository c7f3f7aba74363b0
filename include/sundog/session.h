// Devices that stay open and draw one scene after the other: for editors and viewers.
#pragma once
#include <sundog/render.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace sundog {
inline namespace v0 {

/// What a session is at.
enum class SessionState {
  idle,       ///< nothing was started
  compiling,  ///< the scene's tables are being made
  preparing,  ///< kernels are being built, or tables uploaded
  drawing,    ///< pixels are being made
  settled,    ///< the picture is complete
  stopped,    ///< Session::cancel() ended it
  failed      ///< Snapshot::error says why
};

/// None of it changes a bit of the settled picture.
struct SessionOptions {
  bool coarse = true;      ///< coarse pixels come first while the picture would take longer
  double patience = 0.15;  ///< seconds that a scene gets for its first picture when a newer one comes
  WorkGroup work_group{};  ///< of the kernels
  int tile = 0;            ///< edge in pixels; 0: chosen by measured speed
};

/// The session at one moment.
struct Snapshot {
  std::uint64_t generation = 0;             ///< the newest Session::start()
  std::uint64_t shown = 0;                  ///< whose picture this is; 0: none yet
  std::uint64_t revision = 0;               ///< grows with each change of anything here
  SessionState state = SessionState::idle;  ///< of the newest start()
  std::string error{};                      ///< of a failed one; else empty
  double fraction = 0;                      ///< of the samples, 0..1
  unsigned samples = 0;                     ///< that each pixel has at least; 0 while the picture is coarse
  unsigned block = 1;                       ///< edge in pixels of the blocks that the picture is made of
  double seconds = 0;                       ///< since the start() of `shown`, or the time that it took
  Image picture{};                          ///< linear RGBA of the scene's size; without pixels at first
};

/// What a pixel's centre shows.
struct Pick {
  std::string object{};    ///< its name; empty: nothing, or without a name
  std::string material{};  ///< its name; empty: nothing, or without a name
  Vec3 position{};         ///< in the world
  Vec3 normal{};           ///< of unit length, in the world
  double depth = 0;        ///< along the view; infinite where nothing is
};

/// Used by any number of threads. It has threads of its own, one a device and one that compiles scenes.
class SUNDOG_API Session {
 public:
  /// Without devices: the one estimated fastest. Throws Error (device).
  explicit Session(const std::vector<Device>& devices = {});
  /// Ends what is in hand: waits for launches (about 50 ms). A driver that hangs or compiles keeps its
  /// thread, which belongs to the devices; to the process where the session chose them.
  ~Session();
  Session(Session&&) noexcept;             ///< `other` can only be destroyed or assigned to afterwards
  Session& operator=(Session&&) noexcept;  ///< ends what was in hand here

  /// Draws this scene, as it is now, from now on: the newest one wins. Returns its generation once the scene
  /// is read; what is drawn then comes by snapshot(). Only the parts that differ from the scene before are
  /// made anew. Throws Error (scene; internal for a frame that takes more memory than there is), and keeps
  /// the scene before.
  std::uint64_t start(const Scene& scene, const SessionOptions& options = {});
  /// Stops drawing; the picture so far stays.
  void cancel();
  /// From the next start() on. Throws Error (device).
  void use_devices(const std::vector<Device>& devices);

  /// Without the picture it takes microseconds.
  Snapshot snapshot(bool with_picture = true) const;
  /// Waits until the newest generation is settled, stopped or failed.
  void wait() const;
  /// The same for at most so many seconds; whether it is.
  bool wait_for(double seconds) const;
  /// Waits until Snapshot::revision differs from `revision`, at most so many seconds; whether it does.
  bool wait_for_change(std::uint64_t revision, double seconds) const;
  /// wait(), then the picture, which has the bits of render(). Throws Error (device) when drawing failed.
  Image finish() const;

  /// What a pixel shows, by one ray. Nothing outside of the frame, without a scene, or when a newer one
  /// comes. The first call may build a kernel (seconds). Throws Error: device, build.
  std::optional<Pick> pick(int x, int y);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace v0
}  // namespace sundog
