#include "compile/lights/all_lights.h"

#include "compile/lights/light_tree.h"
#include "compile/lights/mesh_lights.h"
#include "compile/lights/photons.h"
#include "scene/light_groups.h"

namespace sundog {
namespace {

/// Writes the numbers of groups into the tables of lights, materials and the environment, after all lights
/// have rows.
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

}  // namespace

void complete_lights(const SceneDescription& scene, const Lights& lights, const Instances& instances,
                     CompiledScene& out) {
  MeshLights with_meshes = add_mesh_lights(scene, out.origin, {lights.lights, out.instances});
  out.lights = std::move(with_meshes.lights);
  out.instances = std::move(with_meshes.instances);
  out.features.area_lights |= with_meshes.any;
  set_light_groups(scene, out);
  LightTree tree = make_light_tree(scene.render, out.lights, lights.light_rays);
  out.light_nodes = std::move(tree.light_nodes);
  out.light_leaves = std::move(tree.light_leaves);
  out.light_rays = std::move(tree.light_rays);
  out.features.light_tree = !out.light_nodes.empty();
  Photons photons = plan_photons(scene, instances.boxes, out);
  out.photon_targets = std::move(photons.photon_targets);
  out.photon_lights = std::move(photons.photon_lights);
  out.photons_by = photons.plan;
  out.features.caustics = !out.photon_targets.empty();
}

}  // namespace sundog
