// Devices in other processes, for `render`: what they are told, and how they find what they are told of.
#pragma once
#include <nlohmann/json.hpp>

#include "app/options.h"
#include "compile/compiled_scene.h"
#include "render/render.h"
#include "render/tile_worker.h"

namespace sundog {

/// What a process needs to render a part of the command's frame on `device` (Message::open).
nlohmann::json remote_settings(const RenderCommand& command, const DeviceInfo& device);

/// Loads the scene of such settings and makes a server of the device. Throws SceneError, DeviceError.
OpenedServer open_server(const nlohmann::json& settings);

/// The devices that a worker process sees: this one makes no OpenCL call.
std::vector<DeviceInfo> enumerate_in_worker();

/// Each device in a worker process of its own, which is started again up to three times.
std::vector<ServerPlan> isolated(const RenderCommand& command, const std::vector<DeviceInfo>& devices,
                                 const CompiledScene& scene);

}  // namespace sundog
