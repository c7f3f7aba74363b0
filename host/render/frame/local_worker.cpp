// Opens the device for a scene, renders tiles with it, and totals its figures over reopenings.
#include "render/frame/local_worker.h"

#include <utility>

#include "base/environment.h"

namespace sundog {
namespace {

void add(WorkerFigures& sum, const WorkerFigures& more) {
  for (const auto& [name, times] : more.kernels) {
    KernelTimes& total = sum.kernels[name];
    total.launches += times.launches;
    total.device_ms += times.device_ms;
    total.host_ms += times.host_ms;
    total.first_ms += times.first_ms;
    total.local_x = times.local_x;
    total.local_y = times.local_y;
  }
  sum.readback_seconds += more.readback_seconds;
  sum.tables_uploaded += more.tables_uploaded;
  sum.bytes_uploaded += more.bytes_uploaded;
  sum.kernels_built += more.kernels_built;
  sum.notes.insert(sum.notes.end(), more.notes.begin(), more.notes.end());
}

}  // namespace

LocalWorker::LocalWorker(DeviceInfo info, std::shared_ptr<const CompiledScene> scene,
                         const RenderOptions& options)
    : info_(std::move(info)), scene_(std::move(scene)), options_(&options), store_(info_) {}

void LocalWorker::show(std::shared_ptr<const CompiledScene> scene, const RenderOptions& options) {
  scene_ = std::move(scene);
  options_ = &options;
  other_scene_ = true;
  draws_draft_ = false;
  store_.builder().may_wait();
  store_.builder().forget_later();  // until the next rest
  closed_ = {};
  readback_before_ = renderer_ ? renderer_->readback_seconds() : 0;
  if (device_) device_->forget_times();
}

void LocalWorker::change_scene(RenderTimes& times) {
  try {
    renderer_->change_scene(*scene_, *options_, times);
  } catch (const NotWantedAnyMore&) {
    works_ = other_scene_ = true;  // the renderer still has its previous scene
    throw;
  }
}

RenderTimes LocalWorker::open() {
  RenderTimes times;
  if (std::exchange(other_scene_, false) && works_) {
    works_ = false;
    change_scene(times);
  } else {
    close();
    readback_before_ = 0;
    device_ = std::make_unique<Device>(info_);
    renderer_.emplace(*device_, *scene_, *options_, times, watch_, &store_);
  }
  works_ = true;
  draws_draft_ = renderer_->draws_draft();
  return times;
}

void LocalWorker::be_nice() {
  if (const auto& step_back = value_of(info_.environment).step_back) step_back();
}

TileResult LocalWorker::render(const TileRequest& request, const StopFlags& flags) {
  works_ = false;
  TileResult result = renderer_->render(request, flags);
  works_ = true;
  return result;
}

void LocalWorker::rest() {
  if (works_) renderer_->rest();
}

void LocalWorker::keep_programs() {
  if (works_) renderer_->keep_programs();
}

WorkerFigures LocalWorker::figures() const {
  WorkerFigures sum = closed_;
  if (!renderer_) return sum;
  const KernelUpdate& made = renderer_->update();
  add(sum, {device_->times(), renderer_->readback_seconds() - readback_before_, renderer_->notes(),
            made.uploads.tables, made.uploads.bytes, made.built});
  return sum;
}

void LocalWorker::close() {
  closed_ = figures();
  renderer_.reset();
  device_.reset();
  works_ = false;
}

WorkerPlan plan_local(std::shared_ptr<const CompiledScene> scene, const DeviceInfo& device) {
  return {device, device.shares_cores() ? 0 : -1,
          [scene = std::move(scene), device](const RenderOptions& options) {
            return std::make_shared<LocalWorker>(device, scene, options);
          }};
}

std::vector<WorkerPlan> plan_local_workers(const std::shared_ptr<const CompiledScene>& scene,
                                           const std::vector<DeviceInfo>& devices) {
  std::vector<WorkerPlan> plans;
  for (const DeviceInfo& device : devices) plans.push_back(plan_local(scene, device));
  return plans;
}

}  // namespace sundog
