// Compiles images and textures (kernels/shared/textures.h).
#pragma once
#include "compile/compiled_scene.h"
#include "compile/mesh_bvh.h"
#include "compile/texels.h"

namespace sundog {

/// Fills the texture and image tables used by the materials of `scene`, and Material::maps of
/// `out.materials`; sets the features. Call after add_materials(). Throws SceneError for an unknown texture.
void add_textures(const SceneDescription& scene, CompiledScene& out);

/// Adds the texture coordinate sets after the first that textures use. Call after add_meshes().
void add_further_uvs(const SceneDescription& scene, const std::vector<PlacedMesh>& meshes,
                     CompiledScene& out);

/// Whether some texture is the vertex colour.
bool takes_vertex_colors(const SceneFeatures& features);

/// Adds the alpha of all vertices, if a texture uses it. Call after add_meshes().
void add_vertex_alphas(const SceneDescription& scene, const std::vector<PlacedMesh>& meshes,
                       CompiledScene& out);

/// A tangent in object space, and whether the bitangent is opposite to cross(normal, tangent).
struct CornerTangent {
  dvec3 tangent;
  bool mirrored;
};

/// Tangents for normal maps at the corners of each triangle (compile/tangents.cpp).
std::vector<CornerTangent> corner_tangents(const Mesh& mesh);

/// Adds packed corner_tangents() of all meshes. Call after add_meshes().
void add_tangents(const SceneDescription& scene, const std::vector<PlacedMesh>& meshes, CompiledScene& out);

/// Whether a material needs more than its Material: it has textures, or is not opaque.
bool has_maps(const MaterialDescription& material);

/// Adds the tables texels0 to texels3, zeroed, each except the last with at least `least_page` units. A page
/// has at most a quarter of all units, the largest allocation that every device supports.
TexelPages add_texel_pages(std::size_t units, u32 least_page, CompiledScene& out);

}  // namespace sundog
