// Draws a draft that `render --write-every` shows while the frame's kernels are built.
#pragma once
#include <memory>

#include "base/driver_threads.h"
#include "compile/compiled_scene.h"
#include "render/values/options.h"

namespace sundog {

/// Draws a draft of a frame in a thread, with kernels that all scenes share, until the frame itself has
/// pixels. Does nothing unless the device's cache has these kernels and lacks the frame's.
class Draft {
 public:
  /// `options`: the frame's options, whose on_picture receives the draft's picture after each pass.
  Draft(std::shared_ptr<const CompiledScene> scene, const DeviceInfo& device, const RenderOptions& options);
  /// Stops the draft; does not wait for the driver.
  ~Draft();
  Draft(const Draft&) = delete;
  Draft& operator=(const Draft&) = delete;

  /// Call once the frame has pixels: stops the draft, which shows nothing from now on.
  void end();
  /// Number of pictures shown.
  unsigned pictures() const;

 private:
  struct State;
  std::shared_ptr<State> state_;
  std::weak_ptr<DriverThreads> owner_;
  DriverThread thread_;
};

}  // namespace sundog
