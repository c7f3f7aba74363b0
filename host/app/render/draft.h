// A draft that `render --write-every` shows while the frame's kernels are built.
#pragma once
#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>

#include "compile/compiled_scene.h"
#include "render/values/options.h"

namespace sundog {

/// Draws a frame beside it, by kernels that all scenes share, if only those are in the device's cache, until
/// the frame itself has pixels.
class Draft {
 public:
  /// `options`: the frame's; what its on_picture gets is the draft's picture, pass by pass.
  Draft(std::shared_ptr<const CompiledScene> scene, const DeviceInfo& device, const RenderOptions& options);
  ~Draft();
  Draft(const Draft&) = delete;
  Draft& operator=(const Draft&) = delete;

  /// The frame has pixels: the draft shows nothing from now on.
  void end();
  /// Pictures of it that were shown.
  unsigned pictures() const { return pictures_; }

 private:
  std::atomic<bool> stop_{false};
  std::atomic<unsigned> pictures_{0};
  std::mutex showing_;
  std::thread thread_;
};

}  // namespace sundog
