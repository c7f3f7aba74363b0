// DeviceScene: a compiled scene's tables in one device's memory. Buffers have the same names here, in
// CompiledScene and in kernels.
#pragma once
#include "compile/compiled_scene.h"
#include "device/device.h"

namespace sundog {

struct DeviceScene {
  Buffer<SceneInfo> info;
#define SUNDOG_TABLE_BUFFER(type, host_type, name, label) Buffer<type> name;
  SCENE_TABLES(SUNDOG_TABLE_BUFFER)
#undef SUNDOG_TABLE_BUFFER
  Buffer<u32> camera_media;  // MediaStack at the camera (kernels/plain/path/media.cl), low word first

  SceneTables held;       // the rows on the device
  SceneInfo held_info{};  // the SceneInfo on the device
  bool compact = false;   // `nodes` are CompactNodes
};

/// Statistics of an upload.
struct UploadFigures {
  std::uint64_t tables = 0, bytes = 0;
  bool numbers = false;  // whether SceneInfo was written; not counted above
};

/// The scene's size on a device in bytes.
std::size_t scene_bytes(const CompiledScene& scene);

/// Throws DeviceError if the device cannot hold the scene. camera_media is empty.
DeviceScene upload_scene(Device& device, const CompiledScene& scene);

/// Changes the scene on a device, writing only tables that differ. Keeps camera_media. After an exception the
/// tables are invalid. Throws like upload_scene().
UploadFigures update_scene(Device& device, const CompiledScene& scene, DeviceScene& held);

#define SUNDOG_TABLE_TYPE(type, host_type, name, label) , Buffer<type>
#define SUNDOG_TABLE_ARGUMENT(type, host_type, name, label) , scene.name
/// A kernel with SCENE_PARAMETERS (kernels/lib/core/tables.h), then Args.
template <class... Args>
using SceneKernel = Kernel<Buffer<SceneInfo> SCENE_TABLES(SUNDOG_TABLE_TYPE), Args...>;

/// Throws BuildError like Program::kernel().
template <class... Args>
SceneKernel<Args...> scene_kernel(const Program& program, const std::string& name) {
  return program.kernel<Buffer<SceneInfo> SCENE_TABLES(SUNDOG_TABLE_TYPE), Args...>(name);
}

/// Device::run() with the scene's tables before `args`.
template <class... Args>
cl::Event run_scene_kernel(Device& device, SceneKernel<Args...>& kernel, const LaunchSize& size,
                           const DeviceScene& scene, const std::type_identity_t<Args>&... args) {
  return device.run(kernel, size, scene.info SCENE_TABLES(SUNDOG_TABLE_ARGUMENT), args...);
}
#undef SUNDOG_TABLE_TYPE
#undef SUNDOG_TABLE_ARGUMENT

}  // namespace sundog
