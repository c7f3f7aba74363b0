// A device of this process as a TileServer.
#pragma once
#include <atomic>
#include <memory>
#include <optional>

#include "render/device/launch_watch.h"
#include "render/device/tile_renderer.h"
#include "render/frame/tile_server.h"

namespace sundog {

class DeviceServer : public SceneServer {
 public:
  /// `options` must outlive it. Opens nothing yet.
  DeviceServer(DeviceInfo info, std::shared_ptr<const CompiledScene> scene, const RenderOptions& options);

  void show(std::shared_ptr<const CompiledScene> scene, const RenderOptions& options) override;
  void prepare_surfaces() override { renderer_->prepare_surfaces(); }
  bool is_open() const override { return works_ && !other_scene_; }
  void hurry() override { builder_.wants_no_more(); }
  bool draws_draft() const override { return draws_draft_; }
  bool may_end_draft() const override;
  void rest() override;
  void keep_programs() override;
  /// The largest work-group that its kernels allow; 0: unknown, or the server is not open.
  std::size_t greatest_group() const { return renderer_ ? renderer_->greatest_group() : 0; }
  std::size_t kernels_waiting() const override { return builder_.waiting(); }

  const DeviceInfo& info() const override { return info_; }
  RenderTimes open() override;
  TileResult render(const TileRequest& request, const StopFlags& flags) override;
  ServerFigures figures() const override;
  void close() override;
  double overdue() const override { return watch_.overdue(); }
  bool compiles() const override { return watch_.compiles(); }
  /// For the calling thread, and those that the driver starts from it.
  void be_nice() override;

 private:
  void change_scene(RenderTimes& times);

  DeviceInfo info_;
  std::shared_ptr<const CompiledScene> scene_;
  const RenderOptions* options_;
  LaunchWatch watch_;
  KernelBuilder builder_;
  std::unique_ptr<Device> device_;
  std::optional<TileRenderer> renderer_;
  std::atomic<bool> draws_draft_{false};
  bool works_ = false;          // nothing has failed since it was opened: fit for another scene
  bool other_scene_ = false;    // open() may keep what suits it
  double readback_before_ = 0;  // of scenes before
  ServerFigures closed_;        // of what was opened before
};

}  // namespace sundog
