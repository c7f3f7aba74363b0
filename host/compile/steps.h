// The steps of compile(), as functions from inputs to results. An input struct names everything that its step
// reads of the description and of other results; memo() recomputes a result only if its inputs' content key
// changed.
#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "compile/compiled_scene.h"
#include "compile/content_key.h"

namespace sundog {

struct FieldView;

/// The scene's file, for messages.
using SceneFile = Unkeyed<std::string>;
inline SceneFile file_of(const SceneDescription& scene) { return {scene.file.string()}; }

/// Whether the world's fog is a medium that scatters light, rather than one that emits it.
bool fog_scatters(const SceneDescription& scene);

struct ViewInputs {
  SceneFile file;
  dvec3 origin;
  const Camera& camera;
  const ImageSettings& image;
  const RenderSettings& render;
};
struct CompiledView {
  SceneInfo info{};
  SceneFeatures features;
  SharedTable<float> filter;
  SharedTable<float4> guides;
};
/// Positions are relative to the origin. Throws SceneError for an empty image, a zero view direction, or an
/// up vector parallel to it.
CompiledView compile_view(const ViewInputs& in);

struct HaloInputs {
  const EnvironmentDescription* environment;
};
/// The description's own map, or else a traced one; null without a halo.
using Halo = std::shared_ptr<const HaloMap>;
Halo compile_halo(const HaloInputs& in);

struct LightInputs {
  SceneFile file{};
  dvec3 origin{0};
  std::span<const LightDescription> lights{};
  const EnvironmentDescription* environment = nullptr;
  Known<Halo> halo{};
  dvec3 fog_color{0};
  double fog_density = 0;  // density of fog that does not scatter
};
/// Lights of the scene file, the environment and its sun, with positions relative to the origin.
struct Lights {
  SharedTable<Light> lights;
  SharedTable<LightRay> light_rays;
  SharedTable<Environment> environments;
  SharedTable<float4> environment;
  SharedTable<float> environment_shares;
  SharedTable<u32> environment_cutpoints;
  SceneFeatures features;
  float4 ambient{}, fog{};
  u32 sees_environment = SEEN_BY_NONE;
};
/// Throws SceneError for a zero direction.
Lights compile_lights(const LightInputs& in);
LightInputs light_inputs(const SceneDescription& scene, const dvec3& origin, const Known<Halo>& halo);

struct SurfaceInputs {
  SceneFile file{};
  bool paths = false, caustics = false;
  bool lacks_materials = false;  // some object or mesh has no material
  std::span<const MediumDescription> media{};
  std::span<const MaterialDescription> materials{};
  std::span<const ImageDescription> images{};
  std::span<const TextureDescription> textures{};
  const FogDescription* fog = nullptr;  // scattering fog, or null
};
struct Surfaces {
  SharedTable<Medium> media;
  SharedTable<float> spectra;
  SharedTable<Material> materials;
  SharedTable<MaterialMaps> material_maps;
  SharedTable<TextureNode> texture_nodes;
  SharedTable<float> texture_values;
  SharedTable<TexelLevel> texel_levels;
  SharedTable<u32> texels0, texels1, texels2, texels3;
  SharedTable<Layers> layers;
  SharedTable<float> layer_rows;
  SceneFeatures features;
  u32 texel_page = 0;
  std::string pattern_source;
  u32 default_material = NO_MATERIAL;  // material of objects without one
};
/// Equal media are merged, except the world's at 0. Throws SceneError for an unknown texture.
Surfaces compile_surfaces(const SurfaceInputs& in);
SurfaceInputs surface_inputs(const SceneDescription& scene);

struct MeshInputs {
  SceneFile file{};
  bool spatial_splits = false;
  u32 default_material = NO_MATERIAL;
  std::size_t material_count = 0;
  std::vector<const Mesh*> meshes{};               // null: no object places it
  std::vector<std::vector<std::size_t>> groups{};  // mesh_groups()
  Unkeyed<std::vector<std::string>> places{};      // place of the first object of each mesh
};
/// A mesh in the tables, with the facts that its instances need.
struct PlacedMesh {
  bool used = false;     // some object places it
  bool follows = false;  // shares the BVH of the previous mesh in the triangle table
  double unit = 1;       // unit of the tables' coordinates in mesh units: a power of two
  u32 root = 0;          // root node of its BVH
  u32 first_vertex = 0, first_triangle = 0;
  u32 triangle_count = 0;
  double cost = 0;             // expected cost of a ray that crosses the BVH's box
  u32 stack = 0;               // traversal stack entries that the BVH may need
  std::vector<Bounds> boxes;   // boxes of its root's grandchildren: a tight hull if rotated
  std::vector<u32> materials;  // distinct materials of its triangles
};
struct Meshes {
  SharedTable<Bvh8Node> nodes;
  SharedTable<TriangleBlock> blocks;
  SharedTable<TriangleShading> triangles;
  SharedTable<Vertex> vertices;
  std::vector<PlacedMesh> placed;  // one for each mesh
  double mean_block_fill = 0;
};
/// A mesh whose largest coordinate is 2^25 or more, or below 2^-24, is scaled to about 1, because products of
/// its edges and transforms would leave a float's range. Throws SceneError for a non-finite or distant
/// vertex, and for an index out of range.
Meshes compile_meshes(const MeshInputs& in);
MeshInputs mesh_inputs(const SceneDescription& scene, const Surfaces& surfaces);

struct MappingInputs {
  Known<Meshes> meshes{};
  Unkeyed<std::vector<const Mesh*>> sources{};
  u32 extra_uvs = 0;  // sets of texture coordinates beside the first
  bool relief = false, vertex_colors = false;
};
/// Further texture coordinates, alpha and tangents that textures need.
struct MeshMapping {
  SharedTable<float> extra_uvs;
  SharedTable<float> vertex_alphas;
  SharedTable<u32> tangents;
};
MeshMapping compile_mapping(const MappingInputs& in);
MappingInputs mapping_inputs(const SceneDescription& scene, const Known<Meshes>& meshes,
                             const Surfaces& surfaces);

/// Properties of a material that instances depend on.
struct SurfaceFacts {
  u32 flags, kind;
  bool shines;
};
struct FieldInterval {
  dvec3 lower, upper;
};
struct InstanceInputs {
  SceneFile file{};
  dvec3 origin{0};
  Known<Meshes> meshes{};
  u32 default_material = NO_MATERIAL;
  std::span<const Object> objects{};
  std::vector<FieldInterval> fields{};
  std::vector<dmat4> planes{};  // place_of_plane() of each plane among the objects
  std::vector<SurfaceFacts> surfaces{};
};
/// Bounded instances come first, in leaf order, then planes, then fields. Planes and fields are outside the
/// scene's BVH. Meshes without triangles get no instance.
struct Instances {
  SharedTable<Bvh8Node> nodes;  // nodes of the BVHs of meshes, and over instances
  SharedTable<Instance> instances;
  SharedTable<float4> moves;
  SharedTable<Turn> turns;
  SharedTable<ProfileArc> profiles;
  SceneFeatures features;
  std::vector<Bounds> boxes;  // one for each instance
  u32 tlas_root = 0, bounded_count = 0, instance_count = 0, field_end = 0;
  float4 scene_center{};
  double sah_cost = 0;
  Bounds box = Bounds::none();
};
/// Throws SceneError for a transform that is not invertible in single precision.
Instances compile_instances(const InstanceInputs& in);
InstanceInputs instance_inputs(const SceneDescription& scene, const dvec3& origin,
                               const Known<Meshes>& meshes, const Surfaces& surfaces);

struct TouchingInputs {
  Known<Instances> instances{};
  double camera_reach = 0;  // camera_reach(): rounding at the camera
  SceneFile file{};
  Unkeyed<dvec3> origin{};
  Unkeyed<std::span<const Object>> objects{};
  Unkeyed<std::span<const Mesh>> meshes{};
};
/// The instances; those that touch others are marked.
struct Touching {
  SharedTable<Instance> instances;
  bool any = false;
};
Touching compile_touching(const TouchingInputs& in);
TouchingInputs touching_inputs(const SceneDescription& scene, const dvec3& origin,
                               const Known<Instances>& instances);

/// `fields` as the camera sees them. In a deep view each field that an object places is compiled by itself,
/// relative to the tables' origin; `fields` then has one entry per instance, in their order.
struct FieldInputs {
  SceneFile file{};
  bool paths = false, deep = false;
  std::vector<SdfDescription> fields{};
  // Only for deep views:
  Known<SharedTable<Instance>> instances{};
  dvec3 origin{0};
  Unkeyed<u32> first_instance{};  // the first that is a field
  Unkeyed<std::span<const Object>> objects{};
};
struct Fields {
  std::string source;  // generated/sdf.cl
  SharedTable<SdfField> sdf_fields;
  SharedTable<float> sdf_parameters;
  SharedTable<Instance> deep_instances;  // instances with the indices of these fields
  SceneFeatures features;
};
Fields compile_field_tables(const FieldInputs& in);
/// `placed`: the instances; those of fields begin at `first`.
FieldInputs field_inputs(const SceneDescription& scene, const dvec3& origin,
                         const std::vector<FieldView>& views, const Known<SharedTable<Instance>>& placed,
                         u32 first);

/// `instances` already have their marks for touching others.
struct AllLightsInputs {
  dvec3 origin;
  float4 camera_position;  // relative to the origin
  std::span<const LightDescription> lights;
  std::span<const MaterialDescription> materials;
  std::span<const Mesh> meshes;
  std::span<const Object> objects;
  const std::string& environment_group;
  std::vector<std::string> groups;  // light_groups()
  const RenderSettings& render;
  const Lights& of_scene;
  const SharedTable<Material>& packed_materials;
  const SharedTable<Instance>& instances;
  std::span<const Bounds> boxes;  // one for each instance
};
/// All lights, including those of meshes, with the tree over them and photons, and the tables that refer to
/// lights or light groups by number.
struct AllLights {
  SharedTable<Light> lights;
  SharedTable<LightRay> light_rays;
  SharedTable<LightNode> light_nodes;
  SharedTable<u32> light_leaves;
  SharedTable<Environment> environments;
  SharedTable<Material> materials;
  SharedTable<Instance> instances;
  SharedTable<PhotonTarget> photon_targets;
  SharedTable<float> photon_lights;
  std::vector<std::string> groups;
  PhotonPlan photons_by;
  SceneFeatures features;
};
AllLights compile_all_lights(const AllLightsInputs& in);
/// `so_far`: the scene with its origin, camera and instances.
AllLightsInputs all_lights_inputs(const SceneDescription& scene, const CompiledScene& so_far,
                                  const Lights& of_scene, const Surfaces& surfaces, const Instances& placed);

ContentKey key_of(const HaloInputs& inputs);
ContentKey key_of(const LightInputs& inputs);
ContentKey key_of(const SurfaceInputs& inputs);
ContentKey key_of(const MeshInputs& inputs);
ContentKey key_of(const MappingInputs& inputs);
ContentKey key_of(const InstanceInputs& inputs);
ContentKey key_of(const TouchingInputs& inputs);
ContentKey key_of(const FieldInputs& inputs);

/// A step's last result.
template <class Value>
struct Memo {
  ContentKey key{};
  Value value{};
  Known<Value> known() const { return {&value, key}; }
};

/// Recomputes the result unless the memo's inputs were equal. Returns whether it did; an exception leaves the
/// memo unchanged.
template <class Value, class Inputs>
bool memo(Memo<Value>& last, const Inputs& inputs, Value (*compile)(const Inputs&)) {
  const ContentKey key = key_of(inputs);
  if (last.key == key) return false;
  last = {key, compile(inputs)};
  return true;
}

}  // namespace sundog
