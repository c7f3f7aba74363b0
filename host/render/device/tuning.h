// Tuning results: one JSON file per device and driver in the cache folder, ignored if the kernels have
// changed since.
#pragma once
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "compile/compiled_scene.h"
#include "device/devices.h"
#include "render/values/tuning.h"
#include "scene/integrators.h"
#include "scene/json/value.h"

namespace sundog {

/// "64", "8x4", "default", "driver".
std::string work_group_text(const WorkGroup& group);
/// The work-group of such a text, also of "auto"; none for other texts.
std::optional<WorkGroup> work_group_of(std::string_view text);

/// "work-group 8x2, 16x1 pixels a work-item, ..."; or "the defaults".
std::string tuning_text(const Tuning& tuning);

/// The kernels that are tuned, each separately.
constexpr const char* frame_kernel = integrators.front().kernel;
constexpr const char* surfaces_kernel = "first_surfaces";  // the AOV kernel; only its surfaces_group is tuned

/// A kernel's Tuning with its measurements: the scene, and the milliseconds of the whole frame (frame_kernel)
/// or of the kernel, with default and tuned settings.
struct TuningEntry {
  std::string kernel = frame_kernel, scene_class, scene;
  Tuning tuning;
  double default_ms = 0, tuned_ms = 0;
};

struct TuningFile {
  std::string platform, device, driver, kernels;  // kernels: hash of their sources
  unsigned units = 0;                             // a sub-device's compute units; 0: the whole device
  std::vector<TuningEntry> entries;               // one per kernel and class
};

/// The class of scenes that share a tuning: "meshes", "solids", "fields"; plus "+wide" or "+compact" if the
/// scene asks for a tracer, the integrator's Integrator::tuning, "+rays" for reflections or refractions.
std::string scene_class(const CompiledScene& scene);

/// The hash of all current kernel sources.
std::string kernels_hash(const HostEnvironment& environment);

/// The folder of tuning files; empty without a cache folder.
std::filesystem::path tuning_folder(const HostEnvironment& environment);
std::filesystem::path tuning_path(const DeviceInfo& device);

nlohmann::json to_json(const TuningFile& file);

/// Throws SceneError with the reason and the place in the file.
TuningFile read_tuning(const JsonValue& value);

/// Reads a tuning file. Throws SceneError.
TuningFile read_tuning_file(const std::filesystem::path& file);

/// The device's stored tuning; nothing if its file is missing, damaged, or for other kernels.
std::optional<TuningFile> load_tuning(const DeviceInfo& device);

/// Stores the entry in the device's file, replacing the entry for the same kernel and class. Throws IoError.
void keep_tuning(const DeviceInfo& device, const TuningEntry& entry);

/// The stored tuning for the device and the scene's class; the default if there is none.
Tuning saved_tuning(const DeviceInfo& device, const CompiledScene& scene);

}  // namespace sundog
