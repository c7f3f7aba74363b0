// The meshes that objects place; texture coordinates, alpha and tangents that textures need.
#include "compile/bvh/mesh_groups.h"
#include "compile/steps.h"
#include "compile/surfaces/textures.h"

namespace sundog {
namespace {

/// The scene's meshes; null for a mesh that no object places.
std::vector<const Mesh*> placed_meshes(const SceneDescription& scene) {
  std::vector<const Mesh*> meshes(scene.meshes.size());
  for (const Object& object : scene.objects)
    if (const auto* shape = std::get_if<MeshShape>(&object.shape)) {
      const auto mesh = static_cast<std::size_t>(shape->mesh);
      meshes[mesh] = &scene.meshes[mesh];
    }
  return meshes;
}

}  // namespace

MeshInputs mesh_inputs(const SceneDescription& scene, const Surfaces& surfaces) {
  MeshInputs in{.file = file_of(scene),
                .spatial_splits = scene.render.spatial_splits,
                .default_material = surfaces.default_material,
                .material_count = scene.materials.size(),
                .meshes = placed_meshes(scene),
                .groups = mesh_groups(scene)};
  in.places.value.resize(scene.meshes.size());
  for (std::size_t i = scene.objects.size(); i-- > 0;)
    if (const auto* shape = std::get_if<MeshShape>(&scene.objects[i].shape))
      in.places.value[static_cast<std::size_t>(shape->mesh)] = scene.objects[i].place;
  return in;
}

MappingInputs mapping_inputs(const SceneDescription& scene, const Known<Meshes>& meshes,
                             const Surfaces& surfaces) {
  return {.meshes = meshes,
          .sources = {placed_meshes(scene)},
          .extra_uvs = surfaces.features.extra_uvs,
          .relief = surfaces.features.relief,
          .vertex_colors = (surfaces.features.texture_kinds >> TEXTURE_VERTEX_COLOR & 1u) != 0};
}

MeshMapping compile_mapping(const MappingInputs& in) {
  return {further_uvs(in), vertex_alphas(in), tangents_of(in)};
}

}  // namespace sundog
