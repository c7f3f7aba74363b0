// Compiles images and textures (kernels/shared/textures.h).
#pragma once
#include "compile/steps.h"
#include "compile/surfaces/texels.h"

namespace sundog {

/// Fills the texture and image tables used by the materials, and Material::maps of `out.materials`. Call
/// after add_materials(). Throws SceneError for an unknown texture.
void add_textures(const SurfaceInputs& in, Surfaces& out);

/// The texture coordinate sets after the first that textures use.
SharedTable<float> further_uvs(const MappingInputs& in);

/// The alpha of all vertices, if a texture uses it.
SharedTable<float> vertex_alphas(const MappingInputs& in);

/// A tangent in object space, and whether the bitangent is opposite to cross(normal, tangent).
struct CornerTangent {
  dvec3 tangent;
  bool mirrored;
};

/// Tangents for normal maps at the corners of each triangle (compile/bvh/tangents.cpp).
std::vector<CornerTangent> corner_tangents(const Mesh& mesh);

/// Packed corner_tangents() of all meshes, if surfaces have relief.
SharedTable<u32> tangents_of(const MappingInputs& in);

/// Whether a material needs more than its Material: it has textures, or is not opaque.
bool has_maps(const MaterialDescription& material);

/// The tables texels0 to texels3, zeroed, each except the last with at least `least_page` units. A page has
/// at most a quarter of all units, the largest allocation that every device supports.
struct TexelTables {
  SharedTable<u32> tables[TEXEL_PAGES];
  TexelPages pages;
  bool several;  // more than one has texels
};
TexelTables make_texel_tables(std::size_t units, u32 least_page);

}  // namespace sundog
