// Whitted's integrator (1980) as a plain C++ program: one thread, recursion, scalar floats, no OpenCL and
// none of the kernels' code. What devices are timed against; it draws the same picture but for rounding.
#pragma once
#include <string>

#include "base/image.h"
#include "compile/compiled_scene.h"

namespace sundog {

/// Why it cannot draw the scene; empty: it can.
std::string plain_refusal(const CompiledScene& scene);

/// Why a picture of it is not the device's but for rounding (rays at silhouettes and checkers fall to either
/// side); empty: it is.
std::string plain_difference(const Image& plain, const Image& device);

/// The whole frame. Linear RGBA, alpha is coverage. The scene is one that plain_refusal() has nothing
/// against.
Image render_plain(const CompiledScene& scene);

}  // namespace sundog
