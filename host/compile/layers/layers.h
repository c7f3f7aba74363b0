// Layered materials as the kernels have them: rows of kernels/shared/layers.h, and what each layer leaves of
// light for those below, found by quadrature of the layer itself.
#pragma once
#include <vector>

#include "compile/compiled_scene.h"

namespace sundog {

/// A row for each material of the scene, and the table of what layers leave, where some material has layers.
void add_layers(const SceneDescription& scene, CompiledScene& out);

/// One material's row; adds to `rows`.
Layers make_layers(const OpenPbr& values, std::vector<float>& rows);

}  // namespace sundog
