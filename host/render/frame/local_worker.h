// A worker that renders tiles with a device of this process.
#pragma once
#include <atomic>
#include <memory>
#include <optional>

#include "render/device/launch_watch.h"
#include "render/frame/device_worker.h"
#include "render/frame/result.h"
#include "render/frame/tile_renderer.h"

namespace sundog {

class LocalWorker : public SceneWorker {
 public:
  /// `options` must outlive this. Does not open the device.
  LocalWorker(DeviceInfo info, std::shared_ptr<const CompiledScene> scene, const RenderOptions& options);

  void show(std::shared_ptr<const CompiledScene> scene, const RenderOptions& options) override;
  void prepare_surfaces() override { renderer_->prepare_surfaces(); }
  bool is_open() const override { return works_ && !other_scene_; }
  void hurry() override { store_.builder().wants_no_more(); }
  bool draws_draft() const override { return draws_draft_; }
  bool may_end_draft() const override { return draws_draft_ && store_.may_end_draft(); }
  void rest() override;
  void keep_programs() override;
  /// Maximum work-group size of its kernels; 0: unknown, or not open.
  std::size_t greatest_group() const { return renderer_ ? renderer_->greatest_group() : 0; }
  std::size_t kernels_waiting() const override { return store_.builder().waiting(); }

  const DeviceInfo& info() const override { return info_; }
  RenderTimes open() override;
  TileResult render(const TileRequest& request, const StopFlags& flags) override;
  WorkerFigures figures() const override;
  void close() override;
  double overdue() const override { return watch_.overdue(); }
  bool compiles() const override { return watch_.compiles(); }
  /// Applies to the calling thread and to threads that the driver starts from it.
  void be_nice() override;

 private:
  void change_scene(RenderTimes& times);

  DeviceInfo info_;
  std::shared_ptr<const CompiledScene> scene_;
  const RenderOptions* options_;
  LaunchWatch watch_;
  KernelStore store_;
  std::unique_ptr<Device> device_;
  std::optional<TileRenderer> renderer_;
  std::atomic<bool> draws_draft_{false};
  bool works_ = false;          // no failure since it was opened: usable for another scene
  bool other_scene_ = false;    // open() may keep kernels and tables
  double readback_before_ = 0;  // from previous scenes
  WorkerFigures closed_;        // from previously opened renderers
};

/// Plans a worker for a device of this process, or for each of several.
WorkerPlan plan_local(std::shared_ptr<const CompiledScene> scene, const DeviceInfo& device);
std::vector<WorkerPlan> plan_local_workers(const std::shared_ptr<const CompiledScene>& scene,
                                           const std::vector<DeviceInfo>& devices);

}  // namespace sundog
