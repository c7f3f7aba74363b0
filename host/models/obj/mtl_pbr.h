// Converts MTL's statements for physically based materials (Pr, Pm, map_Pr and others; Exocortex, 2015), as
// Blender and Rhino write them, to glTF's materials.
#pragma once
#include "models/obj/mtl_statements.h"

namespace sundog::models {

/// The keywords of numbers, in lower case.
inline constexpr std::string_view pbr_numbers[] = {"pr", "pm", "ps", "pc", "pcr", "aniso", "anisor"};

/// Whether such statements make a material. Numbers that are all zeros mean that they are unused.
bool has_pbr(const MtlStatements& stated);

/// Adds the material that glTF has for the statements (gltf/gltf_materials.h), without relief and a texture
/// of opacity; returns its index. Kd is the base colour, `opacity` its alpha, Ni the index above 1, Tf
/// transmits through a thin wall. Without Pr, Ns gives the roughness by Blender's formula.
int add_pbr(const MtlStatements& stated, double opacity, const Source& obj, MtlTextures& textures,
            Model& model);

}  // namespace sundog::models
