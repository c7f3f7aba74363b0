// Compiles geometry: meshes, their texture coordinates, and instances.
#include "compile/mesh_groups.h"
#include "compile/parts/parts.h"
#include "compile/placing/instances.h"
#include "compile/textures.h"
#include "compile/touching/touching.h"

namespace sundog {
namespace {

/// Material properties that instances depend on.
void add_facts(const Material& material, KeyMaker& key) {
  const float4& shines = material.emission;
  constexpr u32 known = MATERIAL_TRANSMITS | MATERIAL_REFLECTS | MATERIAL_SHADOW_OPAQUE | MATERIAL_THIN;
  key.add(material.flags & known).add(material.reflection.w > 0);
  key.add(shines.x != 0 || shines.y != 0 || shines.z != 0);
}

}  // namespace

ContentKey meshes_key(const SceneDescription& scene, const SurfacesPart& surfaces) {
  KeyMaker key;
  key.add(scene.render.spatial_splits).add(surfaces.default_material).add(scene.materials.size());
  key.add(scene.meshes.size());
  std::vector<bool> used(scene.meshes.size());
  for (const Object& object : scene.objects)
    if (const auto* shape = std::get_if<MeshShape>(&object.shape)) used[std::size_t(shape->mesh)] = true;
  for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
    key.add(bool(used[i]));
    if (used[i]) key.add(scene.meshes[i]);
  }
  for (const std::vector<std::size_t>& group : mesh_groups(scene)) key.add_all(group);
  return key.key();
}

MeshesPart make_meshes(const SceneDescription& scene, const SurfacesPart& surfaces) {
  MeshesPart part;
  part.placed = add_meshes(scene, surfaces.default_material, part.made);
  return part;
}

ContentKey mapping_key(const MeshesPart& meshes, const SurfacesPart& surfaces) {
  const SceneFeatures& features = surfaces.made.features;
  return KeyMaker()
      .add(meshes.key)
      .add(features.extra_uvs)
      .add(features.relief)
      .add(takes_vertex_colors(features))
      .key();
}

ScenePart make_mapping(const SceneDescription& scene, const MeshesPart& meshes,
                       const SurfacesPart& surfaces) {
  CompiledScene all = meshes.made;
  all.features = surfaces.made.features;
  add_further_uvs(scene, meshes.placed, all);
  add_vertex_alphas(scene, meshes.placed, all);
  add_tangents(scene, meshes.placed, all);
  ScenePart part;
  part.made.extra_uvs = all.extra_uvs;
  part.made.vertex_alphas = all.vertex_alphas;
  part.made.tangents = all.tangents;
  return part;
}

ContentKey instances_key(const SceneDescription& scene, const MeshesPart& meshes,
                         const SurfacesPart& surfaces, const dvec3& origin) {
  KeyMaker key;
  key.add(meshes.key).add(surfaces.default_material).add(origin).add(scene.objects.size());
  for (const Object& object : scene.objects) {
    key.add(object.shape).add(object.material).add(object.world_from_object).add(object.moves_by);
    key.add(object.turns.size());
    for (const auto& [frame, axis, degrees, about, growth, moves_by] : object.turns)
      key.add_each(frame, axis, degrees, about, growth, moves_by);
    if (std::holds_alternative<PlaneShape>(object.shape)) key.add(place_of_plane(scene, object, origin));
  }
  for (const SdfDescription& field : scene.fields) key.add(field.lower).add(field.upper);
  for (const Material& material : surfaces.made.materials) add_facts(material, key);
  return key.key();
}

InstancesPart make_instances(const SceneDescription& scene, const MeshesPart& meshes,
                             const SurfacesPart& surfaces, const dvec3& origin) {
  InstancesPart part;
  CompiledScene& made = part.made;
  made.origin = origin;
  made.nodes = meshes.made.nodes;
  made.materials = surfaces.made.materials;
  part.boxes = add_instances(scene, meshes.placed, surfaces.default_material, made);
  made.materials = {};
  return part;
}

ContentKey touching_key(const SceneDescription& scene, const InstancesPart& instances, const dvec3& origin) {
  return KeyMaker().add(instances.key).add(camera_reach(scene, origin)).key();
}

ScenePart make_touching(const SceneDescription& scene, const InstancesPart& instances, const dvec3& origin) {
  ScenePart part;
  part.made.info = instances.made.info;
  part.made.instances = instances.made.instances;
  part.made.origin = origin;
  find_touching(scene, instances.boxes, part.made);
  return part;
}

}  // namespace sundog
