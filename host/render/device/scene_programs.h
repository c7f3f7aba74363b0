// Lists all programs that drawing a scene may need.
#pragma once
#include <compare>
#include <string>
#include <vector>

#include "compile/compiled_scene.h"
#include "device/device.h"

namespace sundog {

struct SceneProgram {
  std::string entry;
  KernelDefines defines;
  GeneratedFiles generated;
  friend auto operator<=>(const SceneProgram&, const SceneProgram&) = default;
};

/// The programs of the integrator and of AOVs; of photons and camera media if the scene has them; of `bench
/// rays` if there is anything to trace. Pure.
std::vector<SceneProgram> scene_programs(const CompiledScene& scene, const DeviceInfo& device);

}  // namespace sundog
