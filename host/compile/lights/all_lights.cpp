// Completes the lights in order of dependency: lights of meshes, group numbers, the tree, photons.
#include "compile/lights/light_tree.h"
#include "compile/lights/mesh_lights.h"
#include "compile/lights/photons.h"
#include "scene/light_groups.h"

namespace sundog {
namespace {

/// Writes group numbers into the tables of lights, materials and the environment, once all lights have rows.
void set_light_groups(const AllLightsInputs& in, AllLights& out) {
  if (in.groups.empty()) return;
  const std::size_t around = number_of_group(in.groups, in.environment_group);
  std::vector<std::size_t> of_rows;
  for (const LightDescription& light : in.lights)
    if (light.type != LightType::ambient) of_rows.push_back(number_of_group(in.groups, light.group));
  auto& lights = out.lights.edit();
  for (std::size_t row = 0; row < lights.size(); ++row)
    if (lights[row].kind != LIGHT_TRIANGLE)  // they have their materials' groups (mesh_lights.cpp)
      lights[row].color.w = static_cast<float>(row < of_rows.size() ? of_rows[row] : around);
  for (Environment& environment : out.environments.edit()) environment.ahead.w = static_cast<float>(around);
  auto& materials = out.materials.edit();
  for (std::size_t i = 0; i < in.materials.size(); ++i)
    materials[i].flags |= static_cast<u32>(number_of_group(in.groups, in.materials[i].group))
                          << MATERIAL_GROUP_SHIFT;
}

}  // namespace

AllLightsInputs all_lights_inputs(const SceneDescription& scene, const CompiledScene& so_far,
                                  const Lights& of_scene, const Surfaces& surfaces, const Instances& placed) {
  return {.origin = so_far.origin,
          .camera_position = so_far.info.camera_position,
          .lights = scene.lights,
          .materials = scene.materials,
          .meshes = scene.meshes,
          .objects = scene.objects,
          .environment_group = scene.environment.group,
          .groups = light_groups(scene),
          .render = scene.render,
          .of_scene = of_scene,
          .packed_materials = surfaces.materials,
          .instances = so_far.instances,
          .boxes = placed.boxes};
}

AllLights compile_all_lights(const AllLightsInputs& in) {
  AllLights out;
  out.groups = in.groups;
  MeshLights with_meshes = add_mesh_lights(in);
  out.lights = std::move(with_meshes.lights);
  out.instances = std::move(with_meshes.instances);
  out.environments = in.of_scene.environments;
  out.materials = in.packed_materials;
  set_light_groups(in, out);
  LightTree tree = make_light_tree(in.render, out.lights, in.of_scene.light_rays);
  out.light_nodes = std::move(tree.light_nodes);
  out.light_leaves = std::move(tree.light_leaves);
  out.light_rays = std::move(tree.light_rays);
  Photons photons = plan_photons(in, out.lights);
  out.photon_targets = std::move(photons.photon_targets);
  out.photon_lights = std::move(photons.photon_lights);
  out.photons_by = photons.plan;
  out.features.area_lights = with_meshes.any;
  out.features.light_tree = !out.light_nodes.empty();
  out.features.caustics = !out.photon_targets.empty();
  return out;
}

}  // namespace sundog
