// Colours of vertices that a file writes as bytes where it should write shares of 1.
#pragma once
#include <glm/glm.hpp>
#include <span>

namespace sundog::models {

/// Makes the colours linear shares of 1 if they are bytes (sRGB): whole numbers from 0 to 255, and one of
/// them above 1. Leaves other colours, such as those of a baked light, as they are.
void share_byte_colors(std::span<glm::vec3> colors);

}  // namespace sundog::models
