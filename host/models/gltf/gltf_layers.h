// Converts glTF materials with layers (KHR_materials_clearcoat, _sheen, _iridescence, _anisotropy, _specular)
// to OpenPBR, and KHR_materials_pbrSpecularGlossiness to metallic-roughness.
#pragma once
#include <nlohmann/json_fwd.hpp>

#include "models/gltf/gltf_json.h"
#include "models/values/material.h"

namespace sundog::models {

/// Writes a document's specular-glossiness materials as metallic-roughness, by Khronos's formula, which needs
/// numbers. With a specular-glossiness texture, such a material is a non-metal of the greatest specular
/// reflectance, times the texture; GltfMaterials takes the roughness from the texture's alpha.
void convert_specular_glossiness(const Source& source, nlohmann::json& document);

/// Whether a material's extensions require layers with every integrator. Excludes materials with a texture
/// for the coat or its roughness.
bool has_layers(const JsonAt& material);

/// Base and specular values, and the extensions:
///   clearcoat    coat of index 1.5
///   sheen        fuzz, weighted by the color's largest component
///   iridescence  thin film of the maximum thickness
///   anisotropy   widths mix(roughness^2, 1, strength^2) along and roughness^2 across the rotated tangent
OpenPbr gltf_openpbr(const JsonAt& material, const MetalRough& base, double ior);

/// Adds these layers to a material, keeping its type, emission, opacity and transmission; thin panes have
/// normal reflectance `reflectance`.
void set_gltf_layers(const OpenPbr& values, double reflectance, MaterialDescription& material);

}  // namespace sundog::models
