// Writes and reads settings as JSON, which names the scene and the frame. The devices of a process share the
// scene that it has loaded.
#include "app/job/remote_devices.h"

#include <nlohmann/json.hpp>

#include <fmt/format.h>

#include "app/options/devices.h"
#include "app/options/option_values.h"
#include "app/process/environment.h"
#include "app/process/standard_streams.h"
#include "base/error.h"
#include "base/json_text.h"
#include "render/device/tuning.h"
#include "render/film/hash.h"
#include "render/frame/local_worker.h"
#include "render/remote/remote_values.h"
#include "render/remote/remote_worker.h"
#include "render/remote/worker_process.h"
#include "scene/load.h"

namespace sundog {
namespace {

using nlohmann::json;

/// This process's device with the same place and name. Throws DeviceError if it is missing.
DeviceInfo find_device(const DeviceInfo& wanted) {
  for (DeviceInfo& device : list_devices())
    if (device.platform == wanted.platform && device.device == wanted.device && device.name == wanted.name) {
      device.sub_units = wanted.sub_units;
      device.first_unit = wanted.first_unit;
      device.estimate = wanted.estimate;
      device.rank = wanted.rank;
      device.host = wanted.host;
      return device;
    }
  throw DeviceError(fmt::format("{}: its process does not find it", wanted.label()));
}

json moment_json(const std::optional<Moment>& moment) {
  if (!moment) return {};
  return {{"frame", moment->frame}, {"samples", moment->samples}, {"seed", moment->seed}};
}

std::shared_ptr<const SceneDescription> read_frame(const json& settings, SceneFrames& frames) {
  const json& moment = settings.at("moment");
  if (!moment.is_object()) return frames.read(settings.at("frame").get<double>());
  const Moment at{moment.at("frame").get<double>(), moment.at("samples").get<int>(),
                  moment.at("seed").get<int>()};
  return at_moment(*frames.read(at.frame), at);
}

std::unique_ptr<SceneFrames> open_frames(const json& scene) {
  if (scene.at("text").is_string()) set_standard_input(scene["text"].get<std::string>());
  const LoadOptions options{.native_code = scene.at("native_code").get<bool>(),
                            .outside_files = scene.at("outside_files").get<bool>(),
                            .environment = program_environment()};
  return std::make_unique<SceneFrames>(scene.at("file").get<std::string>(),
                                       scene.at("overrides").get<std::vector<std::string>>(), options);
}

std::shared_ptr<const CompiledScene> load_flat(const json& settings) {
  std::optional<double> frame;
  if (settings.at("frame").is_number()) frame = settings["frame"].get<double>();
  return std::make_shared<const CompiledScene>(compile(*open_frames(settings.at("scene"))->read(frame)));
}

/// Compiles a frame of an animation; keeps the scene's files and tables for the next frame.
std::shared_ptr<const CompiledScene> load_frame(const json& settings, KeptOpen& kept) {
  const std::string of_all = json_text(settings.at("scene"));
  if (kept.frames_settings != of_all) kept.frames = open_frames(settings.at("scene"));
  kept.frames_settings = of_all;
  return std::make_shared<const CompiledScene>(kept.compiler.compile(*read_frame(settings, *kept.frames)));
}

/// Loads the scene once for all devices of this process.
std::shared_ptr<const CompiledScene> load_once(const json& settings, KeptOpen& kept) {
  const std::string of_scene = json_text({settings.at("scene"), settings.at("frame"), settings.at("moment")});
  const std::lock_guard lock(kept.mutex);
  if (kept.scene_settings != of_scene)
    kept.scene = settings.at("frame").is_number() ? load_frame(settings, kept) : load_flat(settings);
  kept.scene_settings = of_scene;
  return kept.scene;
}

std::shared_ptr<KeptDevice> kept_device(const DeviceInfo& device, KeptOpen& kept) {
  const std::lock_guard lock(kept.mutex);
  std::shared_ptr<KeptDevice>& one = kept.devices[device.label()];
  if (!one) one = std::make_shared<KeptDevice>();
  return one;
}

/// Lends a kept device to one frame, and leaves it open afterwards.
class BorrowedWorker : public DeviceWorker {
 public:
  explicit BorrowedWorker(SceneWorker& worker) : worker_(worker) {}
  const DeviceInfo& info() const override { return worker_.info(); }
  RenderTimes open() override { return worker_.open(); }
  TileResult render(const TileRequest& request, const StopFlags& flags) override {
    return worker_.render(request, flags);
  }
  WorkerFigures figures() const override { return worker_.figures(); }
  void close() override { worker_.rest(); }
  double overdue() const override { return worker_.overdue(); }
  bool compiles() const override { return worker_.compiles(); }
  void be_nice() override { worker_.be_nice(); }

 private:
  SceneWorker& worker_;
};

/// Keeps alive what a worker refers to during a frame. The lock is the last member, so it is released first.
struct RemoteFrame {
  RenderOptions options;
  std::shared_ptr<const CompiledScene> scene;
  std::shared_ptr<KeptDevice> device;
  std::unique_lock<std::mutex> in_use;
};

std::shared_ptr<DeviceWorker> worker_of(RemoteFrame& frame, const DeviceInfo& device) {
  if (!frame.device) return std::make_shared<LocalWorker>(find_device(device), frame.scene, frame.options);
  std::shared_ptr<SceneWorker>& worker = frame.device->worker;
  if (!worker) worker = std::make_shared<LocalWorker>(find_device(device), frame.scene, frame.options);
  worker->show(frame.scene, frame.options);
  return std::make_shared<BorrowedWorker>(*worker);
}

}  // namespace

std::shared_ptr<const SceneDescription> at_moment(SceneDescription scene, const Moment& moment) {
  scene.render.samples = moment.samples;
  scene.render.seed = moment.seed;
  return std::make_shared<const SceneDescription>(std::move(scene));
}

json remote_settings(const RenderCommand& command, const DeviceInfo& device) {
  return {{"scene",
           {{"file", command.scene},
            {"text", is_standard_input(command.scene) ? json(standard_input()) : json()},
            {"overrides", command.overrides},
            {"native_code", command.native_code},
            {"outside_files", command.outside_files}}},
          {"frame", command.frame ? json(*command.frame) : json()},
          {"moment", moment_json(command.moment)},
          {"aovs", made_aovs(command)},
          {"work_group", command.work_group},
          {"device", device},
          {"nice", false}};
}

OpenedWorker open_worker(const json& settings, KeptOpen* kept) {
  const auto device = settings.at("device").get<DeviceInfo>();
  const auto frame = std::make_shared<RemoteFrame>();
  if (kept) {
    frame->device = kept_device(device, *kept);
    frame->in_use = std::unique_lock(frame->device->in_use);
  }
  frame->options.work_group = settings.at("work_group").get<WorkGroup>();
  frame->options.aovs = settings.at("aovs").get<std::vector<std::string>>();
  frame->scene = kept ? load_once(settings, *kept) : load_flat(settings);
  frame->options.tuning = [flat = frame->scene](const DeviceInfo& info) { return saved_tuning(info, *flat); };
  OpenedWorker opened;
  opened.scene = hash_scene(*frame->scene);
  opened.kept = frame;
  opened.worker = worker_of(*frame, device);
  if (settings.at("nice").get<bool>()) opened.worker->be_nice();
  return opened;
}

std::vector<DeviceInfo> enumerate_in_worker() {
  const std::unique_ptr<Channel> channel = start_worker(*program_environment(), "the list of devices");
  channel->send({Message::list, {}, {}});
  while (true) {
    const std::optional<Message> answer = channel->receive(1);
    if (!answer) continue;
    return understood("the list of devices", [&] {
      if (answer->kind == Message::failed) throw DeviceError(answer->values.at("what").get<std::string>());
      channel->send({Message::close, {}, {}});
      auto devices = answer->values.at("devices").get<std::vector<DeviceInfo>>();
      for (DeviceInfo& device : devices) device.environment = program_environment();
      return devices;
    });
  }
}

KeptChannels::Connect connect_worker(const RenderCommand& command, const DeviceInfo& device,
                                     const KeptChannels& workers, KeptChannels::Connect connect) {
  if (!command.frame) return connect;
  return workers.kept(fmt::format("{} {}", device.rank, device.label()), std::move(connect));
}

WorkerPlan plan_isolated(const RenderCommand& command, const DeviceInfo& device, std::uint64_t scene_hash,
                         const KeptChannels& workers) {
  const auto start = [label = device.label()] { return start_worker(*program_environment(), label); };
  const RemoteDevice remote{device,
                            device.shares_cores() ? 0 : -1,
                            connect_worker(command, device, workers, start),
                            remote_settings(command, device),
                            scene_hash,
                            worker_restarts,
                            worker_restarts + 1};
  return {device, remote.processor,
          [remote](const RenderOptions&) { return std::make_shared<RemoteWorker>(remote); }};
}

}  // namespace sundog
