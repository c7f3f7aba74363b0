// Whitted's integrator (1980) as a plain C++ program: one thread, recursion, scalar floats, no OpenCL and
// none of the kernels' code. Devices are timed against it; it renders the same picture up to rounding.
#pragma once
#include <string>

#include "base/image.h"
#include "compile/compiled_scene.h"

namespace sundog {

/// Why it cannot render the scene; empty if it can.
std::string plain_refusal(const CompiledScene& scene);

/// How its picture differs from the device's by more than rounding (rays at silhouettes and checkers may fall
/// to either side); empty if it does not.
std::string plain_difference(const Image& plain, const Image& device);

/// Renders the whole frame: linear RGBA, alpha is coverage. plain_refusal() must be empty for the scene.
Image render_plain(const CompiledScene& scene);

}  // namespace sundog
