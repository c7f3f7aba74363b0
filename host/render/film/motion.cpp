// See motion.h.
#include "render/film/motion.h"

#include <cmath>

#include "base/error.h"

namespace sundog {
namespace {

using glm::dmat4;
using glm::dvec2;
using glm::dvec4;

/// The world point, or with w = 0 the direction of the sky, that a pixel shows at this place and depth.
dvec4 seen(const Shot& shot, const dmat4& world_from_ndc, const dvec2& ndc, double depth) {
  // An orthographic camera sees no part of the sky move.
  const auto& m = shot.world_to_ndc;
  const bool parallel = m[0][3] == 0 && m[1][3] == 0 && m[2][3] == 0;
  if (std::isinf(depth)) return parallel ? dvec4(0) : world_from_ndc * dvec4(ndc, 1, 1);
  if (parallel) return world_from_ndc * dvec4(ndc, depth, 1);
  const double near = shot.world_to_ndc[3][3] - shot.world_to_ndc[3][2];  // scene/shot.cpp
  return world_from_ndc * dvec4(ndc * depth, depth - near, depth);
}

}  // namespace

void find_motion(AovImages& aovs, const Shot& shot, const std::optional<Region>& region) {
  const auto found = aovs.find(motion_aov);
  if (found == aovs.end()) return;
  if (!shot.next) throw UsageError("the AOV motion wants the next frame's camera");
  const Image surfaces = std::move(found->second);
  const dmat4 world_from_ndc = glm::inverse(shot.world_to_ndc);
  const Region shown = region.value_or(Region{0, 0, surfaces.width, surfaces.height});
  const dvec2 size(shown.whole_width, shown.whole_height), corner(shown.x, shown.y);
  Image motion(surfaces.width, surfaces.height, 2);
  for (std::size_t i = 0; i < motion.data.size() / 2; ++i) {
    const float* pixel = &surfaces.data[static_cast<std::size_t>(surfaces.channels) * i];
    const auto width = static_cast<std::size_t>(surfaces.width);
    const dvec2 place = corner + dvec2(i % width, i / width) + 0.5;
    dvec4 world = seen(shot, world_from_ndc, place / size, double(pixel[0]));
    const auto moves = shot.next->moves.find(static_cast<int>(pixel[4]));
    if (moves != shot.next->moves.end()) world = moves->second * world;
    const dvec4 next = shot.next->world_to_ndc * world;
    if (!(next.w > 0)) continue;
    const dvec2 way = dvec2(next) / next.w * size - place;
    motion.data[2 * i] = static_cast<float>(way.x);
    motion.data[2 * i + 1] = static_cast<float>(-way.y);
  }
  found->second = std::move(motion);
}

}  // namespace sundog
