// What the kernels are specialised to: the scene's features and the device's class, as sorted -D definitions.
#pragma once
#include "compile/compiled_scene.h"
#include "device/device.h"
#include "render/values/tuning.h"

namespace sundog {

/// The shape of a work-item's pixels, and the definitions that the kernels are built with
/// (kernels/lib/core/config.h has their defaults).
struct KernelConfig {
  unsigned tile_w = 4, tile_h = 4;  // pixels a work-item
  unsigned ray_stack = 0;           // rays that may wait in a work-item
  KernelDefines defines;
  GeneratedFiles generated;   // the scene's formulas as kernel code
  bool has_programs = false;  // the scene has its fields as programs too
  friend bool operator==(const KernelConfig&, const KernelConfig&) = default;
};

/// Whether the kernels run the programs of any scene's fields, slowly, instead of code made for one scene's.
bool interprets(const KernelConfig& config);

/// Whether the device runs one ray a lane over compact nodes: by its class, unless the scene says which.
bool traces_compact(const CompiledScene& scene, const DeviceInfo& device);

/// Pure. Devices with vectors take 4x4 pixels a work-item and eight boxes an instruction, the others a pixel.
KernelConfig make_kernel_config(const CompiledScene& scene, const DeviceInfo& device,
                                const Tuning& tuning = {});

/// Whether kernels of `general` draw all that those of `wanted` draw, to the bit: they differ in definitions
/// that leave every bit of a scene that does without, and in room.
bool stands_in(const KernelConfig& general, const KernelConfig& wanted);

/// Those that stand in for the scene's, and for those of scenes with most other materials, lights and solids,
/// of the same formulas. A path tracer's are its own. Pure.
KernelConfig general_config(const CompiledScene& scene, const DeviceInfo& device, const Tuning& tuning = {});

/// The same for scenes of any other formulas. Only where the scene's fields are programs too. Pure.
KernelConfig interpreting_config(const CompiledScene& scene, const DeviceInfo& device,
                                 const Tuning& tuning = {});

/// Whether kernels of `draft` draw what those of `wanted` draw but for rounding: they have all its features.
bool drafts(const KernelConfig& draft, const KernelConfig& wanted);

/// Those of all features but fog, lens, filter and what moves, which are the scene's: slow, and of other
/// rounding, so their picture is replaced. Only where interpreting_config() may be built. Pure.
KernelConfig draft_config(const CompiledScene& scene, const DeviceInfo& device, const Tuning& tuning = {});

/// Those of general_config(), where there are fields those that interpret them, the first with and without
/// what else an edit switches on or off by a number (fog, a lens), and drafts. Those come first that most
/// edits want. Pure.
std::vector<KernelConfig> general_configs(const CompiledScene& scene, const DeviceInfo& device,
                                          const Tuning& tuning = {});

/// Most work-items that a group of the render kernels may have; 0: the device does not say.
std::size_t greatest_work_group(const KernelConfig& config, const DeviceInfo& device);

}  // namespace sundog
