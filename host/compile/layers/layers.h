// Compiles layered materials to rows of kernels/shared/layers.h, with the light that each layer transmits to
// the layers below, by quadrature.
#pragma once
#include "compile/layers/base.h"
#include "compile/steps.h"

namespace sundog {

/// Adds a row for each material, and the table of transmitted light, if some material has layers.
void add_layers(const SurfaceInputs& in, Surfaces& out);

/// One material's row, with a grid if one of `textures` gives its roughness or coat weight; adds to `rows`.
Layers make_layers(const OpenPbr& values, const MaterialTextures& textures, LayerRows& rows);

}  // namespace sundog
