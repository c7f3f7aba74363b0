#include "render/device/device_scene.h"

#include <fmt/format.h>

#include <array>

#include "base/error.h"
#include "render/device/compact_nodes.h"
#include "render/device/kernel_config.h"

namespace sundog {
namespace {

constexpr std::size_t camera_media_words = 2;

/// Uploads tables, which must fit into one allocation each.
class Uploader {
 public:
  explicit Uploader(Device& device, bool compact) : device_(device), compact_(compact) {}

  template <class T>
  Buffer<T> operator()(const char* label, const std::vector<T>& table) {
    const std::size_t bytes = table.size() * sizeof(T), most = device_.info().max_allocation;
    if (most && bytes > most)
      throw DeviceError(
          fmt::format("{}: the scene's {} take {} MiB, more than the {} MiB that one allocation may have",
                      device_.info().label(), label, bytes >> 20, most >> 20));
    return device_.upload(std::span<const T>(table));
  }
  /// Nodes are of two kinds, so the kernels have them as words.
  Buffer<u32> operator()(const char* label, const std::vector<Bvh8Node>& nodes) {
    return compact_ ? as_words(operator()<CompactNode>(label, compact_nodes(nodes)))
                    : as_words(operator()<Bvh8Node>(label, nodes));
  }

 private:
  template <class T>
  static Buffer<u32> as_words(const Buffer<T>& table) {
    return {table.memory, table.count * sizeof(T) / sizeof(u32)};
  }
  Device& device_;
  bool compact_;
};

}  // namespace

std::size_t scene_bytes(const CompiledScene& scene) {
  return sizeof(SceneInfo) + table_bytes(scene) + camera_media_words * sizeof(u32);
}

DeviceScene upload_scene(Device& device, const CompiledScene& scene) {
  const DeviceInfo& info = device.info();
  if (info.global_memory && scene_bytes(scene) > info.global_memory)
    throw DeviceError(fmt::format("{}: the scene takes {} MiB, more than the device's {} MiB", info.label(),
                                  scene_bytes(scene) >> 20, info.global_memory >> 20));
  Uploader upload(device, traces_compact(scene, info));
  DeviceScene result;
  result.info = device.upload(std::span<const SceneInfo>(&scene.info, 1));
#define SUNDOG_UPLOAD_TABLE(type, host_type, name, label) result.name = upload(label, scene.name);
  SCENE_TABLES(SUNDOG_UPLOAD_TABLE)
#undef SUNDOG_UPLOAD_TABLE
  constexpr std::array<u32, camera_media_words> outside{};
  result.camera_media = device.upload(std::span<const u32>(outside));
  return result;
}

}  // namespace sundog
