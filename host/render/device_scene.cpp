#include "render/device_scene.h"

#include <fmt/format.h>

#include <array>

#include "base/error.h"
#include "render/compact_nodes.h"
#include "render/kernel_config.h"

namespace sundog {
namespace {

constexpr std::size_t camera_media_words = 2;

template <class T>
std::size_t table_bytes(const std::vector<T>& table) {
  return table.size() * sizeof(T);
}

template <class T>
Buffer<u32> as_words(const Buffer<T>& table) {
  return {table.memory, table.count * sizeof(T) / sizeof(u32)};
}

}  // namespace

std::size_t scene_bytes(const CompiledScene& scene) {
  return sizeof(SceneInfo) + table_bytes(scene.nodes) + table_bytes(scene.blocks) +
         table_bytes(scene.instances) + table_bytes(scene.triangles) + table_bytes(scene.vertices) +
         table_bytes(scene.materials) + table_bytes(scene.media) + table_bytes(scene.lights) +
         table_bytes(scene.fields.fields) + table_bytes(scene.fields.parameters) +
         camera_media_words * sizeof(u32);
}

DeviceScene upload_scene(Device& device, const CompiledScene& scene) {
  const DeviceInfo& info = device.info();
  const auto table = [&]<class T>(const char* name, const std::vector<T>& values) {
    if (info.max_allocation && table_bytes(values) > info.max_allocation)
      throw DeviceError(
          fmt::format("{}: the scene's {} take {} MiB, more than the {} MiB that one allocation may have",
                      info.label(), name, table_bytes(values) >> 20, info.max_allocation >> 20));
    return device.upload(std::span<const T>(values));
  };
  if (info.global_memory && scene_bytes(scene) > info.global_memory)
    throw DeviceError(fmt::format("{}: the scene takes {} MiB, more than the device's {} MiB", info.label(),
                                  scene_bytes(scene) >> 20, info.global_memory >> 20));
  DeviceScene result;
  result.info = device.upload(std::span<const SceneInfo>(&scene.info, 1));
  result.nodes = traces_compact(scene, info) ? as_words(table("BVH nodes", compact_nodes(scene.nodes)))
                                             : as_words(table("BVH nodes", scene.nodes));
  result.blocks = table("triangle blocks", scene.blocks);
  result.instances = table("instances", scene.instances);
  result.triangles = table("triangles", scene.triangles);
  result.vertices = table("vertices", scene.vertices);
  result.materials = table("materials", scene.materials);
  result.media = table("media", scene.media);
  result.lights = table("lights", scene.lights);
  result.sdf_fields = table("fields", scene.fields.fields);
  result.sdf_parameters = table("field parameters", scene.fields.parameters);
  constexpr std::array<u32, camera_media_words> outside{};
  result.camera_media = device.upload(std::span<const u32>(outside));
  return result;
}

}  // namespace sundog
