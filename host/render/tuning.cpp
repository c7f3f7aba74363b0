// See tuning.h.
#include "render/tuning.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdio>

#include "base/error.h"
#include "base/file.h"
#include "device/embedded_kernels.h"
#include "device/program_cache.h"

namespace sundog {
namespace {

using nlohmann::json;
using enum WorkGroup::Kind;

WorkGroup work_group_from(const std::string& text, const std::string& where) {
  if (text == "default") return {};
  if (text == "driver") return {driver, 0, 0};
  unsigned x = 0, y = 1;
  char rest = 0;
  const int found = std::sscanf(text.c_str(), "%ux%u%c", &x, &y, &rest);
  const bool plain = found == 1 && text == std::to_string(x);
  if ((!plain && found != 2) || x == 0 || y == 0 || x > 65536 || y > 65536)
    throw SceneError(where, "work_group", fmt::format("wanted a size such as 64 or 8x8, found {}", text));
  return {fixed, x, y};
}

json entry_json(const TuningEntry& entry) {
  return {{"kernel", entry.kernel},
          {"class", entry.scene_class},
          {"scene", entry.scene},
          {"work_group", work_group_text(entry.tuning.work_group)},
          {"surfaces_group", work_group_text(entry.tuning.surfaces_group)},
          {"tile_w", entry.tuning.tile_w},
          {"tile_h", entry.tuning.tile_h},
          {"packet_least", entry.tuning.packet_least},
          {"launch_ms", entry.tuning.launch_ms},
          {"tile_ms", entry.tuning.tile_ms},
          {"default_ms", entry.default_ms},
          {"tuned_ms", entry.tuned_ms}};
}

TuningEntry entry_from(const json& entry, const std::string& where) {
  TuningEntry result;
  result.kernel = entry.at("kernel");
  result.scene_class = entry.at("class");
  result.scene = entry.at("scene");
  result.tuning.work_group = work_group_from(entry.at("work_group"), where);
  result.tuning.surfaces_group = work_group_from(entry.at("surfaces_group"), where);
  result.tuning.tile_w = entry.at("tile_w");
  result.tuning.tile_h = entry.at("tile_h");
  result.tuning.packet_least = entry.at("packet_least");
  result.tuning.launch_ms = entry.at("launch_ms");
  result.tuning.tile_ms = entry.at("tile_ms");
  result.default_ms = entry.at("default_ms");
  result.tuned_ms = entry.at("tuned_ms");
  const Tuning& tuning = result.tuning;
  if (result.kernel != frame_kernel && result.kernel != surfaces_kernel)
    throw SceneError(where, "kernel",
                     fmt::format("wanted {} or {}, found {}", frame_kernel, surfaces_kernel, result.kernel));
  if (tuning.tile_w > 16 || tuning.tile_h > 16 || (tuning.tile_w == 0) != (tuning.tile_h == 0) ||
      tuning.packet_least > 64 || !(tuning.launch_ms >= 0 && tuning.launch_ms <= 10000) ||
      !(tuning.tile_ms >= 0 && tuning.tile_ms <= 10000))
    throw SceneError(where, result.scene_class, "a value is out of its range");
  return result;
}

}  // namespace

std::string work_group_text(const WorkGroup& group) {
  if (group.kind == automatic) return "default";
  if (group.kind == driver) return "driver";
  return group.y > 1 ? fmt::format("{}x{}", group.x, group.y) : fmt::format("{}", group.x);
}

std::string tuning_text(const Tuning& tuning) {
  std::vector<std::string> parts;
  if (tuning.work_group.kind != automatic)
    parts.push_back("work-group " + work_group_text(tuning.work_group));
  if (tuning.surfaces_group.kind != automatic)
    parts.push_back("work-group " + work_group_text(tuning.surfaces_group));
  if (tuning.tile_w) parts.push_back(fmt::format("{}x{} pixels a work-item", tuning.tile_w, tuning.tile_h));
  if (tuning.packet_least) parts.push_back(fmt::format("packets of more than {}", tuning.packet_least));
  if (tuning.launch_ms > 0) parts.push_back(fmt::format("launches of {} ms", tuning.launch_ms));
  if (tuning.tile_ms > 0) parts.push_back(fmt::format("tiles of {} ms", tuning.tile_ms));
  return parts.empty() ? "the defaults" : fmt::format("{}", fmt::join(parts, ", "));
}

std::string scene_class(const CompiledScene& scene) {
  const auto& shapes = scene.features.shapes;
  std::string kind = shapes[SHAPE_SDF] ? "fields" : shapes[SHAPE_MESH] ? "meshes" : "solids";
  if (scene.tracer == Tracer::wide) kind += "+wide";
  if (scene.tracer == Tracer::compact) kind += "+compact";
  return scene.features.secondary_rays ? kind + "+rays" : kind;
}

std::string kernels_hash() {
  std::string all;
  for (const EmbeddedKernel& file : embedded_kernels())
    all += fmt::format("{}\n{}\n", file.path, embedded_kernel(std::string(file.path)));
  return hash128(all);
}

std::filesystem::path tuning_folder() {
  const std::filesystem::path cache = cache_directory();
  return cache.empty() ? cache : cache / "tuning";
}

std::filesystem::path tuning_path(const DeviceInfo& device) {
  const std::filesystem::path folder = tuning_folder();
  if (folder.empty()) return folder;
  const std::string key =
      fmt::format("{}\n{}\n{}\n{}", device.platform_name, device.name, device.driver, device.sub_units);
  return folder / (hash128(key) + ".json");
}

json to_json(const TuningFile& file) {
  json entries = json::array();
  for (const TuningEntry& entry : file.entries) entries.push_back(entry_json(entry));
  return {{"schema", 1},           {"platform", file.platform}, {"device", file.device},
          {"driver", file.driver}, {"kernels", file.kernels},   {"units", file.units},
          {"entries", entries}};
}

TuningFile tuning_from_json(const json& value, const std::string& where) {
  try {
    if (value.at("schema") != 1)
      throw SceneError(where, "schema", "wanted 1, which `sundog tune --export` writes");
    TuningFile file{value.at("platform"), value.at("device"), value.at("driver"),
                    value.at("kernels"),  value.at("units"),  {}};
    for (const json& entry : value.at("entries")) file.entries.push_back(entry_from(entry, where));
    return file;
  } catch (const json::exception& error) {
    throw SceneError(where, "", fmt::format("is no tuning result of sundog: {}", error.what()));
  }
}

std::optional<TuningFile> load_tuning(const DeviceInfo& device) {
  const std::filesystem::path path = tuning_path(device);
  if (path.empty() || !std::filesystem::exists(path)) return {};
  try {
    TuningFile file = tuning_from_json(json::parse(read_file(path), nullptr, false), path.string());
    if (file.kernels == kernels_hash()) return file;
  } catch (const std::runtime_error&) {  // damaged: as if it were not there
  }
  return {};
}

void keep_tuning(const DeviceInfo& device, const TuningEntry& entry) {
  const std::filesystem::path path = tuning_path(device);
  if (path.empty()) throw IoError("there is no cache folder to keep the result in: set XDG_CACHE_HOME");
  TuningFile file = load_tuning(device).value_or(
      TuningFile{device.platform_name, device.name, device.driver, kernels_hash(), device.sub_units, {}});
  std::erase_if(file.entries, [&](const TuningEntry& old) {
    return old.kernel == entry.kernel && old.scene_class == entry.scene_class;
  });
  file.entries.push_back(entry);
  std::error_code failed;
  std::filesystem::create_directories(path.parent_path(), failed);
  write_file(path, to_json(file).dump(2) + "\n");
}

Tuning saved_tuning(const DeviceInfo& device, const CompiledScene& scene) {
  const std::optional<TuningFile> file = load_tuning(device);
  if (!file) return {};
  Tuning tuning;
  WorkGroup surfaces_group;
  for (const TuningEntry& entry : file->entries) {
    if (entry.scene_class != scene_class(scene)) continue;
    if (entry.kernel == surfaces_kernel)
      surfaces_group = entry.tuning.surfaces_group;
    else
      tuning = entry.tuning;
  }
  tuning.surfaces_group = surfaces_group;
  return tuning;
}

}  // namespace sundog
