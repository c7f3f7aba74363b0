#include "render/device/device_server.h"
#include "device/device_pool.h"

#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace sundog {
namespace {

void add(ServerFigures& sum, const ServerFigures& more) {
  for (const auto& [name, times] : more.kernels) {
    KernelTimes& total = sum.kernels[name];
    total.launches += times.launches;
    total.device_ms += times.device_ms;
    total.host_ms += times.host_ms;
    total.local_x = times.local_x;
    total.local_y = times.local_y;
  }
  sum.readback_seconds += more.readback_seconds;
  sum.notes.insert(sum.notes.end(), more.notes.begin(), more.notes.end());
}

}  // namespace

DeviceServer::DeviceServer(DeviceInfo info, std::shared_ptr<const CompiledScene> scene,
                           const RenderOptions& options)
    : info_(std::move(info)), scene_(std::move(scene)), options_(options) {}

RenderTimes DeviceServer::open() {
  close();
  RenderTimes times;
  device_ = options_.pool ? options_.pool->take(info_) : std::make_unique<Device>(info_);
  renderer_.emplace(*device_, *scene_, options_, times, watch_);
  works_ = true;
  return times;
}

void DeviceServer::be_nice() { ::setpriority(PRIO_PROCESS, static_cast<id_t>(::syscall(SYS_gettid)), 19); }

TileResult DeviceServer::render(const TileRequest& request, const StopFlags& flags) {
  works_ = false;
  TileResult result = renderer_->render(request, flags);
  works_ = true;
  return result;
}

ServerFigures DeviceServer::figures() const {
  ServerFigures sum = closed_;
  if (renderer_) add(sum, {device_->times(), renderer_->readback_seconds(), renderer_->notes()});
  return sum;
}

void DeviceServer::close() {
  closed_ = figures();
  renderer_.reset();
  if (device_ && works_ && options_.pool) options_.pool->give_back(std::move(device_));
  device_.reset();
  works_ = false;
}

}  // namespace sundog
