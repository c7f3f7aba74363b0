// glTF's materials with layers as OpenPBR's (KHR_materials_clearcoat, _sheen, _iridescence, _anisotropy).
#pragma once
#include "scene/materials/openpbr.h"
#include "scene/models/gltf/gltf_json.h"

namespace sundog::models {

/// Whether a material has an extension that makes it one of layers. Those whose layers vary by a texture of
/// the coat, or whose roughness does, are not taken so.
bool has_layers(const JsonAt& material);

/// Adds to `values`, which have base and specular values, those of the extensions:
///   clearcoat    coat of the index 1.5
///   sheen        fuzz of the weight of the color's greatest part
///   iridescence  thin film of the greatest thickness
///   anisotropy   widths mix(roughness^2, 1, strength^2) along the tangent and roughness^2 across, and its
///   turn
void add_gltf_layers(const JsonAt& material, OpenPbr& values);

}  // namespace sundog::models
