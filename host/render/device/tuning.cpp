// Names files by a hash of platform, device, driver and units, keeps one entry per kernel and scene class,
// and treats damaged files as missing.
#include "render/device/tuning.h"

#include <nlohmann/json.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "base/cache_folder.h"
#include "base/environment.h"
#include "base/error.h"
#include "base/file.h"
#include "base/json_text.h"
#include "base/limits.h"
#include "base/numbers.h"
#include "device/embedded_kernels.h"
#include "device/program_cache.h"

namespace sundog {
namespace {

using nlohmann::json;
using enum WorkGroup::Kind;

json entry_json(const TuningEntry& entry) {
  json result{{"kernel", entry.kernel},
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
  if (!entry.tuning.options.empty()) result["options"] = entry.tuning.options;
  return result;
}

std::string class_of(const CompiledScene& scene, const Integrator& integrator) {
  const auto& shapes = scene.features.shapes;
  std::string kind = shapes[SHAPE_SDF] ? "fields" : shapes[SHAPE_MESH] ? "meshes" : "solids";
  if (scene.tracer == Tracer::wide) kind += "+wide";
  if (scene.tracer == Tracer::compact) kind += "+compact";
  kind += integrator.tuning;
  return scene.features.secondary_rays ? kind + "+rays" : kind;
}

}  // namespace

std::string work_group_text(const WorkGroup& group) {
  if (group.kind == automatic) return "default";
  if (group.kind == driver) return "driver";
  return group.y > 1 ? fmt::format("{}x{}", group.x, group.y) : fmt::format("{}", group.x);
}

std::optional<WorkGroup> work_group_of(std::string_view text) {
  if (text == "auto" || text == "default") return WorkGroup{};
  if (text == "driver") return WorkGroup{driver, 0, 0};
  const std::size_t cross = std::min(text.find('x'), text.size());
  const auto x = whole_number<int>(text.substr(0, cross));
  const auto y = cross < text.size() ? whole_number<int>(text.substr(cross + 1)) : 1;
  if (std::clamp(x.value_or(0), 1, most_edge) != x || std::clamp(y.value_or(0), 1, most_edge) != y) return {};
  return WorkGroup{fixed, static_cast<std::size_t>(*x), static_cast<std::size_t>(*y)};
}

std::string tuning_text(const Tuning& tuning) {
  std::vector<std::string> parts;
  if (tuning.work_group.kind != automatic)
    parts.push_back("work-group " + work_group_text(tuning.work_group));
  if (tuning.surfaces_group.kind != automatic)
    parts.push_back(fmt::format("work-group {} for first surfaces", work_group_text(tuning.surfaces_group)));
  if (tuning.tile_w) parts.push_back(fmt::format("{}x{} pixels a work-item", tuning.tile_w, tuning.tile_h));
  if (tuning.packet_least) parts.push_back(fmt::format("packets of more than {}", tuning.packet_least));
  if (tuning.launch_ms > 0) parts.push_back(fmt::format("launches of {} ms", tuning.launch_ms));
  if (tuning.tile_ms > 0) parts.push_back(fmt::format("tiles of {} ms", tuning.tile_ms));
  if (!tuning.options.empty()) parts.push_back("compiled with " + tuning.options);
  return parts.empty() ? "the defaults" : fmt::format("{}", fmt::join(parts, ", "));
}

std::string scene_class(const CompiledScene& scene) {
  return class_of(scene, integrator_of(scene.integrator));
}

std::string kernels_hash(const HostEnvironment& environment) {
  std::string all;
  for (const EmbeddedKernel& file : embedded_kernels())
    all += fmt::format("{}\n{}\n", file.path, embedded_kernel(std::string(file.path), environment.kernels));
  return hash128(all);
}

std::filesystem::path tuning_folder(const HostEnvironment& environment) {
  return cache_folder(environment.cache, "tuning");
}

std::filesystem::path tuning_path(const DeviceInfo& device) {
  std::filesystem::path folder = tuning_folder(value_of(device.environment));
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

std::optional<TuningFile> load_tuning(const DeviceInfo& device) {
  const std::filesystem::path path = tuning_path(device);
  if (path.empty() || !is_there(path)) return {};
  try {
    TuningFile file = read_tuning_file(path);
    if (file.kernels == kernels_hash(value_of(device.environment))) return file;
  } catch (const std::runtime_error&) {  // damaged: treat as missing
  }
  return {};
}

void keep_tuning(const DeviceInfo& device, const TuningEntry& entry) {
  const std::filesystem::path path = tuning_path(device);
  if (path.empty()) throw IoError(cache_refusal(value_of(device.environment).cache));
  TuningFile file = load_tuning(device).value_or(TuningFile{device.platform_name,
                                                            device.name,
                                                            device.driver,
                                                            kernels_hash(value_of(device.environment)),
                                                            device.sub_units,
                                                            {}});
  std::erase_if(file.entries, [&](const TuningEntry& old) {
    return old.kernel == entry.kernel && old.scene_class == entry.scene_class;
  });
  file.entries.push_back(entry);
  make_cache_folder(path.parent_path());
  write_file(path, json_text(to_json(file), 2) + "\n");
}

Tuning saved_tuning(const DeviceInfo& device, const CompiledScene& scene) {
  const std::optional<TuningFile> file = load_tuning(device);
  if (!file) return {};
  const std::string own = scene_class(scene);
  // Used for others too, except `options`, which the first integrator's tuning did not compare for them.
  const std::string of_first = class_of(scene, integrators.front());
  Tuning tuning;
  WorkGroup surfaces_group;
  for (const std::string& wanted : {of_first, own})
    for (const TuningEntry& entry : file->entries) {
      if (entry.scene_class != wanted) continue;
      if (entry.kernel == surfaces_kernel)
        surfaces_group = entry.tuning.surfaces_group;
      else
        tuning = entry.tuning;
      if (wanted != own) tuning.options.clear();
    }
  tuning.surfaces_group = surfaces_group;
  return tuning;
}

}  // namespace sundog
