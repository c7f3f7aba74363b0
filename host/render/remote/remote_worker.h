// A worker whose device belongs to another process, reached through a channel.
#pragma once
#include <functional>
#include <memory>

#include "render/frame/device_worker.h"
#include "render/remote/channel.h"

namespace sundog {

/// How to reach a remote device, and the task it gets.
struct RemoteDevice {
  DeviceInfo info;
  int processor = -1;                                 // DeviceSpeed::processor
  std::function<std::unique_ptr<Channel>()> connect;  // throws DeviceError
  nlohmann::json settings;                            // sent with Message::open
  std::uint64_t scene = 0;                            // expected hash_scene()
  unsigned restarts = 0;                              // maximum number of reconnections
  unsigned failures = 3;                              // DeviceWorker::failures_allowed()
};

class RemoteWorker : public DeviceWorker {
 public:
  explicit RemoteWorker(RemoteDevice device) : device_(std::move(device)) {}

  const DeviceInfo& info() const override { return device_.info; }
  RenderTimes open() override;
  TileResult render(const TileRequest& request, const StopFlags& flags) override;
  WorkerFigures figures() const override;
  void close() override;
  void be_nice() override { device_.settings["nice"] = true; }
  unsigned failures_allowed() const override { return device_.failures; }
  int processor() const override { return device_.processor; }

 private:
  RenderTimes try_open();
  Message answer(Message::Kind expected, const StopFlags& flags);
  [[noreturn]] void fail(const nlohmann::json& failure);

  RemoteDevice device_;
  std::unique_ptr<Channel> channel_;
  std::uint64_t job_ = 0;
  WorkerFigures figures_;           // as of the last tile
  std::vector<std::string> notes_;  // added on this side
  unsigned restarts_ = 0;
  std::string hangs_;  // the failure message, once its driver hangs
};

}  // namespace sundog
