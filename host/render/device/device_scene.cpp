// Uploads the tables that differ from those on the device, after checking that they fit.
#include "render/device/device_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <functional>
#include <span>
#include <utility>

#include "base/error.h"
#include "render/device/compact_nodes.h"
#include "render/device/kernel_config.h"

namespace sundog {
namespace {

constexpr std::size_t camera_media_words = 2;

template <class T>
bool same_rows(const SharedTable<T>& a, const SharedTable<T>& b) {
  if (a.shares(b)) return true;
  if (a.size() != b.size()) return false;
  return a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

/// Uploads tables that differ from the device's; each must fit into one allocation.
class Uploader {
 public:
  explicit Uploader(Device& device, bool compact) : device_(device), compact_(compact) {}

  template <class T>
  void operator()(const char* label, const SharedTable<T>& table, SharedTable<T>& held, Buffer<T>& buffer) {
    if (buffer.memory() && same_rows(table, held)) return;
    put(label, table, buffer);
    held = table;
  }
  /// Nodes have two formats, so kernels take them as words.
  void operator()(const char* label, const SharedTable<Bvh8Node>& nodes, SharedTable<Bvh8Node>& held,
                  Buffer<u32>& buffer) {
    if (buffer.memory() && same_rows(nodes, held)) return;
    if (compact_)
      as_words<CompactNode>(buffer, [&](Buffer<CompactNode>& rows) {
        write(label, std::span<const CompactNode>(compact_nodes(nodes.rows())), rows);
      });
    else
      as_words<Bvh8Node>(buffer, [&](Buffer<Bvh8Node>& rows) { put(label, nodes, rows); });
    held = nodes;
  }
  const UploadFigures& figures() const { return figures_; }

 private:
  void check_size(const char* label, std::size_t bytes) const {
    const std::size_t most = device_.info().max_allocation;
    if (most && bytes > most)
      throw DeviceError(
          fmt::format("{}: the scene's {} take {} MiB, more than the {} MiB that one allocation may have",
                      device_.info().label(), label, bytes >> 20, most >> 20));
  }
  void count(std::size_t bytes) {
    figures_.bytes += bytes;
    figures_.tables += bytes > 0;
  }
  /// Shares large tables in place if the device can; small ones are copied, so that their buffers can be
  /// rewritten.
  template <class T>
  void put(const char* label, const SharedTable<T>& table, Buffer<T>& buffer) {
    constexpr std::size_t large = std::size_t{1} << 20;
    const std::span<const T> rows = table.rows();
    if (!device_.shares_memory() || rows.size_bytes() < large) return write(label, rows, buffer);
    check_size(label, rows.size_bytes());
    buffer = {}, buffer = device_.share(rows, table.owner());
    count(rows.size_bytes());
  }
  /// Reuses the buffer if the size is unchanged.
  template <class T>
  void write(const char* label, std::span<const T> table, Buffer<T>& buffer) {
    check_size(label, table.size_bytes());
    if (buffer.memory() && buffer.count == table.size())
      device_.write(buffer, table);
    else
      buffer = {}, buffer = device_.upload(table);
    count(table.size_bytes());
  }
  template <class T>
  static void as_words(Buffer<u32>& buffer, const std::function<void(Buffer<T>&)>& fill) {
    Buffer<T> rows{buffer.memory, buffer.count * sizeof(u32) / sizeof(T)};
    fill(rows);
    buffer = {rows.memory, rows.count * sizeof(T) / sizeof(u32)};
  }
  Device& device_;
  bool compact_;
  UploadFigures figures_;
};

}  // namespace

std::size_t scene_bytes(const CompiledScene& scene) {
  return sizeof(SceneInfo) + table_bytes(scene) + camera_media_words * sizeof(u32);
}

UploadFigures update_scene(Device& device, const CompiledScene& scene, DeviceScene& held) {
  const DeviceInfo& info = device.info();
  if (info.global_memory && scene_bytes(scene) > info.global_memory)
    throw DeviceError(fmt::format("{}: the scene takes {} MiB, more than the device's {} MiB", info.label(),
                                  scene_bytes(scene) >> 20, info.global_memory >> 20));
  const bool compact = traces_compact(scene, info);
  if (compact != std::exchange(held.compact, compact)) held.nodes = {};
  Uploader upload(device, compact);
  const bool other_numbers = !std::ranges::equal(std::as_bytes(std::span(&held.held_info, 1)),
                                                 std::as_bytes(std::span(&scene.info, 1)));
  if (!held.info.memory())
    held.info = device.upload(std::span<const SceneInfo>(&scene.info, 1));
  else if (other_numbers)
    device.write(held.info, std::span<const SceneInfo>(&scene.info, 1));
  held.held_info = scene.info;
#define SUNDOG_UPLOAD_TABLE(type, host_type, name, label) \
  upload(label, scene.name, held.held.name, held.name);
  SCENE_TABLES(SUNDOG_UPLOAD_TABLE)
#undef SUNDOG_UPLOAD_TABLE
  UploadFigures figures = upload.figures();
  figures.numbers = other_numbers;
  return figures;
}

DeviceScene upload_scene(Device& device, const CompiledScene& scene) {
  DeviceScene result;
  update_scene(device, scene, result);
  constexpr std::array<u32, camera_media_words> outside{};
  result.camera_media = device.upload(std::span<const u32>(outside));
  return result;
}

}  // namespace sundog
