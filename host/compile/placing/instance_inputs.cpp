// Collects the inputs of compile_instances() from the scene, its meshes and its surfaces.
#include "compile/placing/instances.h"
#include "compile/steps.h"
#include "compile/surfaces/lobes.h"

namespace sundog {
namespace {

SurfaceFacts facts_of(const Material& material) {
  u32 known = MATERIAL_SHADOW_OPAQUE | MATERIAL_THIN | MATERIAL_WALL | MATERIAL_FROSTED | MATERIAL_CATCHER;
  for (const LobeRow& lobe : lobe_rows)
    if (lobe.feature) known |= lobe.flags;
  const float4& shines = material.emission;
  return {material.flags & known, material.kind, shines.x != 0 || shines.y != 0 || shines.z != 0};
}

}  // namespace

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

}  // namespace sundog
