// Compiles images and textures (kernels/shared/textures.h).
#pragma once
#include "compile/steps.h"
#include "compile/surfaces/texels.h"

namespace sundog {

/// Fills the texture and image tables used by the materials, and Material::maps of `out.materials`. Call
/// after add_materials(). Throws SceneError for an unknown texture.
void add_textures(const SurfaceInputs& in, Surfaces& out);

/// Whether a material needs a MaterialMaps: for textures, partial opacity, one side, metalness or a coat.
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
