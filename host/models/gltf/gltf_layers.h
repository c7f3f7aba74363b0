// Converts glTF materials with layers (KHR_materials_clearcoat, _sheen, _iridescence, _anisotropy, _specular)
// to OpenPBR.
#pragma once
#include "models/gltf/gltf_json.h"
#include "models/values/material.h"

namespace sundog::models {

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
