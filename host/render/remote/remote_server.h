// A device that another process has, as a TileServer.
#pragma once
#include <functional>
#include <memory>

#include "render/frame/tile_server.h"
#include "render/remote/channel.h"

namespace sundog {

/// How a remote device is reached and what it is to do.
struct RemoteDevice {
  DeviceInfo info;
  int processor = -1;                                 // DeviceSpeed::processor
  std::function<std::unique_ptr<Channel>()> connect;  // throws DeviceError
  nlohmann::json settings;                            // of Message::open
  std::uint64_t scene = 0;                            // hash_scene() of what it must render
  unsigned restarts = 0;                              // how often it may be connected to again
  unsigned failures = 3;                              // TileServer::failures_allowed()
};

class RemoteServer : public TileServer {
 public:
  explicit RemoteServer(RemoteDevice device) : device_(std::move(device)) {}

  const DeviceInfo& info() const override { return device_.info; }
  RenderTimes open() override;
  TileResult render(const TileRequest& request, const StopFlags& flags) override;
  ServerFigures figures() const override;
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
  ServerFigures figures_;           // as of the last tile
  std::vector<std::string> notes_;  // of this side
  unsigned restarts_ = 0;
  std::string hangs_;  // what was said when its driver was seen to hang
};

}  // namespace sundog
