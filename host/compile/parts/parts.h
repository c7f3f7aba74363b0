// The parts of a compiled scene, each with the content key of its inputs.
#pragma once
#include "compile/compiled_scene.h"
#include "compile/fields/sdf_deep.h"
#include "compile/mesh_bvh.h"
#include "compile/parts/content_key.h"

namespace sundog {

/// One part's tables, features and numbers, in a scene without the other parts (except those it reads).
struct ScenePart {
  ContentKey key;
  CompiledScene made;
};

struct SurfacesPart : ScenePart {
  u32 default_material = NO_MATERIAL;
};

struct MeshesPart : ScenePart {
  std::vector<PlacedMesh> placed;
};

struct InstancesPart : ScenePart {
  std::vector<Bounds> boxes;  // one per instance
};

/// The map of a halo, if any.
struct HaloPart {
  ContentKey key;
  std::shared_ptr<const HaloMap> map;
};

ContentKey halo_key(const SceneDescription& scene);
/// Returns the description's own map, or traces one.
HaloPart make_halo(const SceneDescription& scene);

ContentKey lights_key(const SceneDescription& scene, const dvec3& origin);
ScenePart make_lights(const SceneDescription& scene, const dvec3& origin, const HaloPart& halo);

ContentKey surfaces_key(const SceneDescription& scene);
SurfacesPart make_surfaces(const SceneDescription& scene);

ContentKey meshes_key(const SceneDescription& scene, const SurfacesPart& surfaces);
MeshesPart make_meshes(const SceneDescription& scene, const SurfacesPart& surfaces);

/// Further texture coordinates and tangents that textures need.
ContentKey mapping_key(const MeshesPart& meshes, const SurfacesPart& surfaces);
ScenePart make_mapping(const SceneDescription& scene, const MeshesPart& meshes, const SurfacesPart& surfaces);

ContentKey instances_key(const SceneDescription& scene, const MeshesPart& meshes,
                         const SurfacesPart& surfaces, const dvec3& origin);
InstancesPart make_instances(const SceneDescription& scene, const MeshesPart& meshes,
                             const SurfacesPart& surfaces, const dvec3& origin);

/// Instances that touch others; the tolerance depends on the camera's position.
ContentKey touching_key(const SceneDescription& scene, const InstancesPart& instances, const dvec3& origin);
ScenePart make_touching(const SceneDescription& scene, const InstancesPart& instances, const dvec3& origin);

/// The fields' views, one per object that is a field.
std::vector<FieldView> views_of(const SceneDescription& scene);

/// `instances`: key of the instances given to make_fields().
ContentKey fields_key(const SceneDescription& scene, const std::vector<FieldView>& views,
                      const ContentKey& instances, const dvec3& origin);
/// In a deep view, each placed field is compiled separately; sets the field indices in `instances`.
ScenePart make_fields(const SceneDescription& scene, const std::vector<FieldView>& views,
                      const CompiledScene& instances);

/// Adds a part's tables and features to the whole.
void take_part(const CompiledScene& part, CompiledScene& out);

}  // namespace sundog
