// A draft that `render --write-every` shows while the frame's kernels are built.
#pragma once
#include <memory>

#include "base/driver_threads.h"
#include "compile/compiled_scene.h"
#include "render/values/options.h"

namespace sundog {

/// Draws a frame beside it, by kernels that all scenes share, if only those are in the device's cache, until
/// the frame itself has pixels.
class Draft {
 public:
  /// `options`: the frame's; what its on_picture gets is the draft's picture, pass by pass.
  Draft(std::shared_ptr<const CompiledScene> scene, const DeviceInfo& device, const RenderOptions& options);
  /// Does not wait for the driver.
  ~Draft();
  Draft(const Draft&) = delete;
  Draft& operator=(const Draft&) = delete;

  /// The frame has pixels: the draft shows nothing from now on.
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
