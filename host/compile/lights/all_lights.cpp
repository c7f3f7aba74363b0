#include "compile/lights/all_lights.h"

#include "compile/lights/light_groups.h"
#include "compile/lights/light_tree.h"
#include "compile/lights/mesh_lights.h"
#include "compile/lights/photons.h"

namespace sundog {

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
