// Devices in other processes, for `render`: makes settings to send to them, and opens workers from these.
#pragma once
#include <map>
#include <memory>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "app/options/options.h"
#include "compile/scene_compiler.h"
#include "render/frame/device_worker.h"
#include "render/remote/kept_channels.h"
#include "render/remote/tile_worker.h"
#include "render/render.h"
#include "scene/load.h"

namespace sundog {

/// The scene of a frame at one moment while its shutter is open, with that moment's samples and seed.
std::shared_ptr<const SceneDescription> at_moment(SceneDescription scene, const Moment& moment);

/// The settings with which another process renders part of the command's frame on `device` (Message::open).
nlohmann::json remote_settings(const RenderCommand& command, const DeviceInfo& device);

/// A device that stays open between frames; one thread uses it at a time.
struct KeptDevice {
  std::mutex in_use;
  std::shared_ptr<SceneWorker> worker;  // null until first used
};

/// Scenes and devices that a serving process keeps open between frames. Any thread may use it.
struct KeptOpen {
  std::mutex mutex;                            // guards the members below
  std::string scene_settings;                  // settings that `scene` was loaded with
  std::shared_ptr<const CompiledScene> scene;  // the last scene
  std::string frames_settings;                 // those settings without the frame
  std::unique_ptr<SceneFrames> frames;         // the animation's frames
  SceneCompiler compiler;
  std::map<std::string, std::shared_ptr<KeptDevice>> devices;  // by label
};

/// Loads the scene that the settings name and makes a worker for their device. With `kept`, waits until no
/// other thread uses the device. Throws SceneError, DeviceError.
OpenedWorker open_worker(const nlohmann::json& settings, KeptOpen* kept);

/// Lists devices in a worker process, so that this one makes no OpenCL call.
std::vector<DeviceInfo> enumerate_in_worker();

/// How often a worker process is restarted before its device is given up.
inline constexpr unsigned worker_restarts = 3;

/// Plans a worker process for the device; the scene must have this hash. Frames of an animation share
/// `workers`.
WorkerPlan plan_isolated(const RenderCommand& command, const DeviceInfo& device, std::uint64_t scene_hash,
                         const KeptChannels& workers);

/// Like `connect`, but reuses the workers of earlier frames of the animation.
KeptChannels::Connect connect_worker(const RenderCommand& command, const DeviceInfo& device,
                                     const KeptChannels& workers, KeptChannels::Connect connect);

}  // namespace sundog
