// Images and textures as the kernels read them (kernels/shared/textures.h).
#pragma once
#include "compile/compiled_scene.h"
#include "compile/mesh_bvh.h"
#include "compile/texels.h"

namespace sundog {

/// Fills the tables of textures and images with what the materials of `scene` use, and Material::maps of
/// `out.materials`; sets the features. After add_materials(). Throws SceneError for a texture that does not
/// exist.
void add_textures(const SceneDescription& scene, CompiledScene& out);

/// The sets of texture coordinates after the first, as far as textures use them. After add_meshes().
void add_further_uvs(const SceneDescription& scene, const std::vector<PlacedMesh>& meshes,
                     CompiledScene& out);

/// Whether some texture is the colour of vertices.
bool takes_vertex_colors(const SceneFeatures& features);

/// The alpha of all vertices, where a texture takes it. After add_meshes().
void add_vertex_alphas(const SceneDescription& scene, const std::vector<PlacedMesh>& meshes,
                       CompiledScene& out);

/// A tangent in object space, and whether the bitangent is against the normal's cross product with it.
struct CornerTangent {
  dvec3 tangent;
  bool mirrored;
};

/// The tangents of normal maps at the corners of each triangle (compile/tangents.cpp).
std::vector<CornerTangent> corner_tangents(const Mesh& mesh);

/// The same, packed, of all meshes. After add_meshes().
void add_tangents(const SceneDescription& scene, const std::vector<PlacedMesh>& meshes, CompiledScene& out);

/// Whether a material is more than its Material: it has textures, or is not opaque.
bool has_maps(const MaterialDescription& material);

/// Gives `out` the tables texels0 to texels3, full of zeros, of at least `least_page` units each but the
/// last. A page is no more than a quarter of all, which is what every device has in one piece.
TexelPages add_texel_pages(std::size_t units, u32 least_page, CompiledScene& out);

}  // namespace sundog
