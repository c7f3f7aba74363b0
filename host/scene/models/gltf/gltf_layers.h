// glTF's materials as OpenPBR's, with their layers (KHR_materials_clearcoat, _sheen, _iridescence,
// _anisotropy, _specular).
#pragma once
#include "scene/description.h"
#include "scene/models/gltf/gltf_json.h"

namespace sundog::models {

/// Whether a material has an extension that makes it one of layers with every integrator. Those whose layers
/// vary by a texture of the coat, or whose roughness does, are not taken so.
bool has_layers(const JsonAt& material);

/// The base and specular values, and those of the extensions:
///   clearcoat    coat of the index 1.5
///   sheen        fuzz of the weight of the color's greatest part
///   iridescence  thin film of the greatest thickness
///   anisotropy   widths mix(roughness^2, 1, strength^2) along the tangent and roughness^2 across, and its
///   turn
OpenPbr gltf_openpbr(const JsonAt& material, const MetalRough& base, double ior);

/// Gives these layers to a material whose type, emission, opacity and transmission stay as they are; thin
/// panes reflect `reflectance` straight on.
void set_gltf_layers(const OpenPbr& values, double reflectance, MaterialDescription& material);

}  // namespace sundog::models
