// See light_groups.h.
#include "compile/lights/light_groups.h"

#include "scene/light_groups.h"

namespace sundog {

void set_light_groups(const SceneDescription& scene, CompiledScene& out) {
  const std::vector<std::string> groups = light_groups(scene);
  if (groups.empty()) return;
  const std::size_t around = number_of_group(groups, scene.environment.group);
  std::vector<std::size_t> of_rows;
  for (const LightDescription& light : scene.lights)
    if (light.type != LightType::ambient) of_rows.push_back(number_of_group(groups, light.group));
  auto& lights = out.lights.edit();
  for (std::size_t row = 0; row < lights.size(); ++row)
    if (lights[row].kind != LIGHT_TRIANGLE)  // those have their materials' (mesh_lights.cpp)
      lights[row].color.w = static_cast<float>(row < of_rows.size() ? of_rows[row] : around);
  for (Environment& environment : out.environments.edit()) environment.ahead.w = static_cast<float>(around);
  auto& materials = out.materials.edit();
  for (std::size_t i = 0; i < scene.materials.size(); ++i)
    materials[i].flags |= static_cast<u32>(number_of_group(groups, scene.materials[i].group))
                          << MATERIAL_GROUP_SHIFT;
}

}  // namespace sundog
