// See inputs.h.
#include "compile/parts/inputs.h"

#include <algorithm>
#include <limits>

#include "compile/materials.h"
#include "compile/mesh_groups.h"
#include "compile/placing/instances.h"
#include "compile/touching/touching.h"
#include "scene/integrators.h"

namespace sundog {
namespace {

SceneFile file_of(const SceneDescription& scene) { return {scene.file.string()}; }

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

SurfaceFacts facts_of(const Material& material) {
  constexpr u32 known = MATERIAL_TRANSMITS | MATERIAL_REFLECTS | MATERIAL_SHADOW_OPAQUE | MATERIAL_THIN |
                        MATERIAL_WALL | MATERIAL_FROSTED;
  const float4& shines = material.emission;
  return {material.flags & known, material.kind, material.reflection.w > 0,
          shines.x != 0 || shines.y != 0 || shines.z != 0};
}

/// Each field for its nearest view.
std::vector<SdfDescription> near_fields(const SceneDescription& scene, const std::vector<FieldView>& views) {
  std::vector<SdfDescription> fields = scene.fields;
  std::vector<double> nearest(fields.size(), std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < views.size(); ++i) {
    const auto* shape = std::get_if<FieldShape>(&scene.objects[i].shape);
    if (!shape) continue;
    const auto field = static_cast<std::size_t>(shape->field);
    if (!(views[i].footprint < nearest[field])) continue;
    nearest[field] = views[i].footprint;
    fields[field] = near_description(scene.fields[field], views[i]);
  }
  return fields;
}

/// Each field as often as objects place it.
std::vector<SdfDescription> placed_fields(const SceneDescription& scene,
                                          const std::vector<FieldView>& views) {
  std::vector<SdfDescription> fields;
  for (std::size_t i = 0; i < views.size(); ++i)
    if (const auto* shape = std::get_if<FieldShape>(&scene.objects[i].shape))
      fields.push_back(near_description(scene.fields[static_cast<std::size_t>(shape->field)], views[i]));
  return fields;
}

}  // namespace

LightInputs light_inputs(const SceneDescription& scene, const dvec3& origin, const Known<Halo>& halo) {
  LightInputs in{.file = file_of(scene),
                 .origin = origin,
                 .lights = scene.lights,
                 .environment = &scene.environment,
                 .halo = halo};
  if (!fog_scatters(scene)) in.fog_color = scene.fog.color, in.fog_density = scene.fog.density;
  return in;
}

SurfaceInputs surface_inputs(const SceneDescription& scene) {
  return {.file = file_of(scene),
          .paths = traces_paths(scene.render.integrator),
          .caustics = scene.render.caustics,
          .lacks_materials = lacks_materials(scene),
          .media = scene.media,
          .images = scene.images,
          .textures = scene.textures,
          .materials = scene.materials,
          .fog = fog_scatters(scene) ? &scene.fog : nullptr};
}

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

InstanceInputs instance_inputs(const SceneDescription& scene, const dvec3& origin,
                               const Known<Meshes>& meshes, const Surfaces& surfaces) {
  InstanceInputs in{.file = file_of(scene),
                    .origin = origin,
                    .meshes = meshes,
                    .default_material = surfaces.default_material,
                    .objects = scene.objects};
  for (const SdfDescription& field : scene.fields) in.fields.push_back({field.lower, field.upper});
  for (const Object& object : scene.objects)
    if (std::holds_alternative<PlaneShape>(object.shape))
      in.planes.push_back(place_of_plane(scene, object, origin));
  for (const Material& material : surfaces.materials) in.surfaces.push_back(facts_of(material));
  return in;
}

TouchingInputs touching_inputs(const SceneDescription& scene, const dvec3& origin,
                               const Known<Instances>& instances) {
  return {.instances = instances,
          .camera_reach = camera_reach(scene, origin),
          .file = file_of(scene),
          .origin = {origin},
          .objects = {scene.objects},
          .meshes = {scene.meshes}};
}

std::vector<FieldView> views_of(const SceneDescription& scene) {
  std::vector<FieldView> views(scene.objects.size());
  for (std::size_t i = 0; i < views.size(); ++i)
    if (std::holds_alternative<FieldShape>(scene.objects[i].shape))
      views[i] = view_of_field(scene, scene.objects[i]);
  return views;
}

bool any_deep(const std::vector<FieldView>& views) { return std::ranges::any_of(views, is_deep); }

FieldInputs field_inputs(const SceneDescription& scene, const dvec3& origin,
                         const std::vector<FieldView>& views, const Known<SharedTable<Instance>>& placed,
                         u32 first) {
  FieldInputs in{
      .file = file_of(scene), .paths = traces_paths(scene.render.integrator), .deep = any_deep(views)};
  if (!in.deep) {
    in.fields = near_fields(scene, views);
    return in;
  }
  in.fields = placed_fields(scene, views);
  in.instances = placed;
  in.origin = origin;
  in.first_instance = {first};
  in.objects = {scene.objects};
  return in;
}

}  // namespace sundog
