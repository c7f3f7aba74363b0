// Devices in other processes, for `render`: what is sent to them, and how they find the files that it names.
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

/// The scene of a frame at one of the times while its shutter is open.
std::shared_ptr<const SceneDescription> at_moment(SceneDescription scene, const Moment& moment);

/// The settings by which another process renders a part of the command's frame on `device` (Message::open).
nlohmann::json remote_settings(const RenderCommand& command, const DeviceInfo& device);

/// A device that stays open from frame to frame, used by one thread at a time.
struct KeptDevice {
  std::mutex in_use;
  std::shared_ptr<SceneWorker> worker;  // null: nobody has asked for it yet
};

/// Scenes and devices that a serving process keeps open between frames. Used by any thread.
struct KeptOpen {
  std::mutex mutex;                            // for what follows
  std::string scene_settings;                  // that the scene was loaded by
  std::shared_ptr<const CompiledScene> scene;  // the last
  std::string frames_settings;                 // the same without the frame
  std::unique_ptr<SceneFrames> frames;         // of an animation
  SceneCompiler compiler;
  std::map<std::string, std::shared_ptr<KeptDevice>> devices;  // by label
};

/// Loads the scene of such settings and makes a worker of the device; with `kept`, waits until nobody else in
/// the process uses that device. Throws SceneError, DeviceError.
OpenedWorker open_worker(const nlohmann::json& settings, KeptOpen* kept);

/// The devices that a worker process sees: this one makes no OpenCL call.
std::vector<DeviceInfo> enumerate_in_worker();

/// How often a worker process is started again.
inline constexpr unsigned worker_restarts = 3;

/// The device in a worker process of its own, for a scene of that hash; of a frame of an animation, in one of
/// `workers`.
WorkerPlan plan_isolated(const RenderCommand& command, const DeviceInfo& device, std::uint64_t scene_hash,
                         const KeptChannels& workers);

/// `connect`, but frames of an animation keep the workers of those before.
KeptChannels::Connect connect_worker(const RenderCommand& command, const DeviceInfo& device,
                                     const KeptChannels& workers, KeptChannels::Connect connect);

}  // namespace sundog
