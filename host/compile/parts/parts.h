// The parts that a compiled scene is put together from, each with the key of all that it is made of.
#pragma once
#include "compile/compiled_scene.h"
#include "compile/fields/sdf_deep.h"
#include "compile/mesh_bvh.h"
#include "compile/parts/content_key.h"

namespace sundog {

/// The tables, features and numbers of one part in a scene that has nothing else (but what it reads).
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
  std::vector<Bounds> boxes;  // of each instance
};

/// The map of a halo, where there is one.
struct HaloPart {
  ContentKey key;
  std::shared_ptr<const HaloMap> map;
};

ContentKey halo_key(const SceneDescription& scene);
/// The description's own map, or else one that is traced here.
HaloPart make_halo(const SceneDescription& scene);

ContentKey lights_key(const SceneDescription& scene, const dvec3& origin);
ScenePart make_lights(const SceneDescription& scene, const dvec3& origin, const HaloPart& halo);

ContentKey surfaces_key(const SceneDescription& scene);
SurfacesPart make_surfaces(const SceneDescription& scene);

ContentKey meshes_key(const SceneDescription& scene, const SurfacesPart& surfaces);
MeshesPart make_meshes(const SceneDescription& scene, const SurfacesPart& surfaces);

/// What textures want of the meshes: further coordinates and tangents.
ContentKey mapping_key(const MeshesPart& meshes, const SurfacesPart& surfaces);
ScenePart make_mapping(const SceneDescription& scene, const MeshesPart& meshes, const SurfacesPart& surfaces);

ContentKey instances_key(const SceneDescription& scene, const MeshesPart& meshes,
                         const SurfacesPart& surfaces, const dvec3& origin);
InstancesPart make_instances(const SceneDescription& scene, const MeshesPart& meshes,
                             const SurfacesPart& surfaces, const dvec3& origin);

/// Which instances lie on others; how near that is follows from the camera's place too.
ContentKey touching_key(const SceneDescription& scene, const InstancesPart& instances, const dvec3& origin);
ScenePart make_touching(const SceneDescription& scene, const InstancesPart& instances, const dvec3& origin);

/// The fields' views, an object each that is one.
std::vector<FieldView> views_of(const SceneDescription& scene);

/// `instances`: the key of what make_fields() is given.
ContentKey fields_key(const SceneDescription& scene, const std::vector<FieldView>& views,
                      const ContentKey& instances, const dvec3& origin);
/// In a deep view each placed field is one of its own: `instances` are given their numbers.
ScenePart make_fields(const SceneDescription& scene, const std::vector<FieldView>& views,
                      const CompiledScene& instances);

/// Puts what a part has into the whole: its tables, and its features beside those that are there.
void take_part(const CompiledScene& part, CompiledScene& out);

}  // namespace sundog
