// Compiles layered materials to rows of kernels/shared/layers.h, with the light that each layer leaves for
// those below, found by quadrature of the layer.
#pragma once
#include "compile/compiled_scene.h"
#include "compile/layers/base.h"

namespace sundog {

/// Adds a row for each material, and the table of transmitted light, if some material has layers.
void add_layers(const SceneDescription& scene, CompiledScene& out);

/// One material's row, with a grid if one of `textures` gives its roughness or coat weight; adds to `rows`.
Layers make_layers(const OpenPbr& values, const MaterialTextures& textures, LayerRows& rows);

}  // namespace sundog
