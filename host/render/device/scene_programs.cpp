// Lists the programs of the integrator and AOVs, then those of media, photons and rays as needed.
#include "render/device/scene_programs.h"

#include "render/device/kernel_config.h"
#include "scene/integrators.h"

namespace sundog {

std::vector<SceneProgram> scene_programs(const CompiledScene& scene, const DeviceInfo& device) {
  const Integrator& integrator = integrator_of(scene.integrator);
  const KernelConfig config = make_kernel_config(scene, device);
  std::vector<SceneProgram> programs;
  const auto add = [&](bool wanted, const char* entry) {
    if (wanted) programs.push_back({entry, config.defines(), config.generated});
  };
  add(true, integrator.entry);
  add(true, "entry/aov.cl");
  add(integrator.needs_camera_media && scene.features.camera_inside, "entry/camera_media.cl");
  add(scene.features.caustics, "entry/trace_photons.cl");
  add(scene.features.caustics, "entry/light_media.cl");
  if (scene.info.instance_count > 0) programs.push_back({"entry/trace_rays.cl", config.defines(), {}});
  return programs;
}

}  // namespace sundog
