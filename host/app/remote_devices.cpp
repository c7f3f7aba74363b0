#include "app/remote_devices.h"

#include <fmt/format.h>

#include "base/error.h"
#include "render/device_server.h"
#include "render/hash.h"
#include "render/remote_server.h"
#include "render/remote_values.h"
#include "render/worker_process.h"
#include "scene/load.h"

namespace sundog {
namespace {

using nlohmann::json;

constexpr unsigned restarts = 3;

/// The device of that place and name on this side.
DeviceInfo find_device(const DeviceInfo& wanted) {
  for (DeviceInfo& device : enumerate_devices())
    if (device.platform == wanted.platform && device.device == wanted.device && device.name == wanted.name) {
      device.sub_units = wanted.sub_units;
      device.estimate = wanted.estimate;
      return device;
    }
  throw DeviceError(fmt::format("{}: its process does not find it", wanted.label()));
}

}  // namespace

json remote_settings(const RenderCommand& command, const DeviceInfo& device) {
  return {{"scene", command.scene},
          {"overrides", command.overrides},
          {"frame", command.frame ? json(*command.frame) : json()},
          {"native_code", command.native_code},
          {"aovs", command.aovs},
          {"work_group", command.work_group},
          {"device", device},
          {"nice", false}};
}

OpenedServer open_server(const json& settings) {
  struct Frame {
    RenderOptions options;
    std::shared_ptr<const CompiledScene> scene;
  };
  const auto frame = std::make_shared<Frame>();
  frame->options.work_group = settings.at("work_group").get<WorkGroup>();
  frame->options.aovs = settings.at("aovs").get<std::vector<std::string>>();
  const auto overrides = settings.at("overrides").get<std::vector<std::string>>();
  LoadOptions options{std::nullopt, settings.at("native_code").get<bool>()};
  if (settings.at("frame").is_number()) options.frame = settings["frame"].get<double>();
  frame->scene = std::make_shared<const CompiledScene>(
      compile(load_scene(settings.at("scene").get<std::string>(), overrides, options)));
  frame->options.tuning = [flat = frame->scene](const DeviceInfo& device) {
    return saved_tuning(device, *flat);
  };
  OpenedServer opened;
  opened.scene = hash_scene(*frame->scene);
  opened.kept = frame;
  opened.server = std::make_shared<DeviceServer>(find_device(settings.at("device").get<DeviceInfo>()),
                                                 frame->scene, frame->options);
  if (settings.at("nice").get<bool>()) opened.server->be_nice();
  return opened;
}

std::vector<DeviceInfo> enumerate_in_worker() {
  const std::unique_ptr<Channel> channel = start_worker("the list of devices");
  channel->send({Message::list, {}, {}});
  while (true) {
    const std::optional<Message> answer = channel->receive(1);
    if (!answer) continue;
    if (answer->kind == Message::failed) throw DeviceError(answer->values.at("what").get<std::string>());
    channel->send({Message::close, {}, {}});
    return answer->values.at("devices").get<std::vector<DeviceInfo>>();
  }
}

std::vector<ServerPlan> isolated(const RenderCommand& command, const std::vector<DeviceInfo>& devices,
                                 const CompiledScene& scene) {
  std::vector<ServerPlan> plans;
  const std::uint64_t hash = hash_scene(scene);
  for (const DeviceInfo& device : devices) {
    RemoteDevice remote{device,
                        device.type == "cpu" ? 0 : -1,
                        [label = device.label()] { return start_worker(label); },
                        remote_settings(command, device),
                        hash,
                        restarts};
    plans.push_back({device, remote.processor,
                     [remote](const RenderOptions&) { return std::make_shared<RemoteServer>(remote); }});
  }
  return plans;
}

}  // namespace sundog
