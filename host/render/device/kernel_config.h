// Specialises kernels to a scene's features and a device's class, by sorted definitions.
#pragma once
#include <map>
#include <string>

#include "compile/compiled_scene.h"
#include "device/device.h"
#include "render/values/tuning.h"

namespace sundog {

using KernelNumbers = std::map<std::string, unsigned>;

/// A work-item's pixels, and the definitions for building kernels (kernels/lib/core/config.h has the
/// defaults).
struct KernelConfig {
  unsigned tile_w = 4, tile_h = 4;  // pixels per work-item
  unsigned ray_stack = 0;           // rays that may wait in a work-item
  KernelNumbers numbers;            // the definitions
  GeneratedFiles generated;         // the scene's formulas as kernel code
  bool has_programs = false;        // the scene also has its fields as programs
  std::string options{};            // Tuning::options
  KernelDefines defines() const;
  friend bool operator==(const KernelConfig&, const KernelConfig&) = default;
};

/// Whether two configurations build the same programs.
inline bool same_kernels(const KernelConfig& a, const KernelConfig& b) {
  return a.numbers == b.numbers && a.generated == b.generated && a.options == b.options;
}

/// Whether the kernels interpret any scene's field programs, slowly, instead of a scene's generated code.
bool interprets(const KernelConfig& config);

/// Whether the device traces one ray per lane over compact nodes: determined by its class, unless the scene
/// decides.
bool traces_compact(const CompiledScene& scene, const DeviceInfo& device);

/// Pure. Devices with vectors process 4x4 pixels per work-item and eight boxes per instruction; others one
/// pixel.
KernelConfig make_kernel_config(const CompiledScene& scene, const DeviceInfo& device,
                                const Tuning& tuning = {});

/// Whether kernels of `general` draw everything that kernels of `wanted` draw, bit for bit: they differ only
/// in capacity and in definitions that do not affect scenes without the feature.
bool stands_in(const KernelConfig& general, const KernelConfig& wanted);

/// Stand-ins for kernels of this scene and of scenes with the same formulas and most other materials, lights
/// and solids. Path tracing has its own stand-ins. Pure.
KernelConfig general_config(const CompiledScene& scene, const DeviceInfo& device, const Tuning& tuning = {});

/// general_config() for scenes with any other formulas, if the scene's fields are also compiled to programs.
/// Pure.
KernelConfig interpreting_config(const CompiledScene& scene, const DeviceInfo& device,
                                 const Tuning& tuning = {});

/// Whether kernels of `draft` draw the picture of `wanted` up to rounding: they have all its features.
bool drafts(const KernelConfig& draft, const KernelConfig& wanted);

/// A draft with all features except the scene's own fog, lens, filter and motion: slow and rounding
/// differently, so its picture is replaced later. general_config() if interpreting_config() cannot be built.
/// Pure.
KernelConfig draft_config(const CompiledScene& scene, const DeviceInfo& device, const Tuning& tuning = {});
/// The draft that draws this scene: general_config() if its fields are not programs, as in very near views.
/// Pure.
KernelConfig drawing_draft_config(const CompiledScene& scene, const DeviceInfo& device,
                                  const Tuning& tuning = {});

/// general_config() and, with fields, interpreting_config(); general_config() also with and without features
/// that an edit toggles by a number (fog, a lens); and drafts. Ordered by how many edits need them. Pure.
std::vector<KernelConfig> general_configs(const CompiledScene& scene, const DeviceInfo& device,
                                          const Tuning& tuning = {});

/// Maximum work-group size of the render kernels; 0: unknown.
std::size_t greatest_work_group(const KernelConfig& config, const DeviceInfo& device);

}  // namespace sundog
