// Several scanners' and point clouds' programs write 255 for white, in OBJ and in float properties of PLY.
#include "models/colors.h"

#include <algorithm>
#include <cmath>

#include "base/image_io.h"

namespace sundog::models {

void share_byte_colors(std::span<glm::vec3> colors) {
  float most = 0;
  for (const glm::vec3& color : colors)
    for (int c = 0; c < 3; ++c) {
      if (!(color[c] >= 0 && color[c] <= 255 && color[c] == std::floor(color[c]))) return;
      most = std::max(most, color[c]);
    }
  if (most <= 1) return;
  for (glm::vec3& color : colors)
    for (int c = 0; c < 3; ++c) color[c] = linear_from_srgb(color[c] / 255);
}

}  // namespace sundog::models
