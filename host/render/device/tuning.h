// What was found to be fastest on a device: one JSON file a device and driver in the cache folder, of no
// account when the kernels have changed since.
#pragma once
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "compile/compiled_scene.h"
#include "device/devices.h"
#include "render/values/tuning.h"
#include "scene/json/value.h"

namespace sundog {

/// "64", "8x4", "default", "driver".
std::string work_group_text(const WorkGroup& group);

/// "group 8x2, 16x1 pixels a work-item, ..."; "the defaults".
std::string tuning_text(const Tuning& tuning);

/// The kernels that are tuned, each by itself.
constexpr const char* frame_kernel = "render_whitted";
constexpr const char* surfaces_kernel = "first_surfaces";  // of the AOVs; its tuning is a surfaces_group

/// A Tuning of one kernel with what was measured: on which scene, and the milliseconds of the whole frame
/// (frame_kernel) or of the kernel with the defaults and with it.
struct TuningEntry {
  std::string kernel = frame_kernel, scene_class, scene;
  Tuning tuning;
  double default_ms = 0, tuned_ms = 0;
};

struct TuningFile {
  std::string platform, device, driver, kernels;  // kernels: hash of their sources
  unsigned units = 0;                             // of a sub-device; 0: the whole device
  std::vector<TuningEntry> entries;               // one a kernel and class
};

/// What scenes have in common that are tuned alike: "meshes", "solids", "fields", with "+rays" where there
/// are reflections or refractions.
std::string scene_class(const CompiledScene& scene);

/// The hash of all kernel sources as they are now.
std::string kernels_hash(const HostEnvironment& environment);

/// The folder of the files; empty where there is no cache folder.
std::filesystem::path tuning_folder(const HostEnvironment& environment);
std::filesystem::path tuning_path(const DeviceInfo& device);

nlohmann::json to_json(const TuningFile& file);

/// Throws SceneError that says what is wrong with it, and where.
TuningFile read_tuning(const JsonValue& value);

/// read_tuning() of a file that holds one. Throws SceneError.
TuningFile read_tuning_file(const std::filesystem::path& file);

/// The device's file; nothing when there is none, it is damaged, or it is of other kernels.
std::optional<TuningFile> load_tuning(const DeviceInfo& device);

/// Puts the entry into the device's file, in place of one of its kernel and class. Throws IoError.
void keep_tuning(const DeviceInfo& device, const TuningEntry& entry);

/// What is kept for the device and the scene's class; the defaults where nothing is.
Tuning saved_tuning(const DeviceInfo& device, const CompiledScene& scene);

}  // namespace sundog
