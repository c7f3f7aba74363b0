// Compiles environment lights: the picture, its sampling tables, and the sky's sun.
#pragma once
#include "compile/steps.h"

namespace sundog {

/// Fills the environment's tables, and adds its light and its sun to the lights; nothing without an
/// environment.
void add_environment(const LightInputs& in, Lights& out);

}  // namespace sundog
