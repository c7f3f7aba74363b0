// Plain kernels from text.
#pragma once
#include <string>

namespace plain_text {

/// A plain file of that text in lanes; it may include "shared/...".
std::string in_lanes(const std::string& text, bool lines = false);

/// The message that it is refused with; fails the test if it is not.
std::string refused(const std::string& text);

/// "ENTRY static float f(float x, int k, UNIFORM int n, UNIFORM __global const float* q, float* o) { body }"
std::string function(const std::string& body);

}  // namespace plain_text
