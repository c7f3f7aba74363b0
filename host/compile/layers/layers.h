// Layered materials as the kernels have them: rows of kernels/shared/layers.h, and what each layer leaves of
// light for those below, found by quadrature of the layer itself.
#pragma once
#include "compile/compiled_scene.h"
#include "compile/layers/base.h"

namespace sundog {

/// A row for each material of the scene, and the table of what layers leave, where some material has layers.
void add_layers(const SceneDescription& scene, CompiledScene& out);

/// One material's row, with a grid where one of `textures` gives its roughness or its coat's weight; adds to
/// `rows`.
Layers make_layers(const OpenPbr& values, const MaterialTextures& textures, LayerRows& rows);

}  // namespace sundog
