// Computes each pixel's world point from its depth, moves it with its object or with the mesh face that
// covers it, and projects it with the next camera.
#include "render/film/motion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "base/error.h"

namespace sundog {
namespace {

using glm::dmat4;
using glm::dvec2;
using glm::dvec4;

/// The world point that a pixel shows at this place and depth, or the direction of the sky, with w = 0.
dvec4 seen(const Shot& shot, const dmat4& world_from_ndc, const dvec2& ndc, double depth) {
  // An orthographic camera sees no motion of the sky.
  const auto& m = shot.world_to_ndc;
  const bool parallel = m[0][3] == 0 && m[1][3] == 0 && m[2][3] == 0;
  if (std::isinf(depth)) return parallel ? dvec4(0) : world_from_ndc * dvec4(ndc, 1, 1);
  if (parallel) return world_from_ndc * dvec4(ndc, depth, 1);
  const double near = shot.world_to_ndc[3][3] - shot.world_to_ndc[3][2];  // scene/shot.cpp
  return world_from_ndc * dvec4(ndc * depth, depth - near, depth);
}

/// The face that covers a pixel's centre and is nearest to the depth that the pixel shows.
struct Covering {
  const MovingFace* face = nullptr;
  glm::dvec3 shares{0};  // barycentric, of the corners
  double off = std::numeric_limits<double>::infinity();
};

/// Notes the face for each pixel of `shown` whose centre it covers, if that pixel shows the face's object.
void cover(const Image& surfaces, const Shot& shot, const Region& shown, int object, const MovingFace& face,
           std::vector<Covering>& pixels) {
  glm::dmat3 corners;  // x and y in pixels of `shown`, times w; w
  glm::dvec3 depths;
  dvec2 low(1e9), high(-1e9);
  for (int c = 0; c < 3; ++c) {
    const dvec4 at = shot.world_to_ndc * dvec4(glm::dvec3(face.now[static_cast<std::size_t>(c)]), 1);
    if (!(at.w > 0)) return;
    const dvec2 place =
        dvec2(at) / at.w * dvec2(shown.whole_width, shown.whole_height) - dvec2(shown.x, shown.y);
    low = glm::min(low, place), high = glm::max(high, place);
    corners[c] = glm::dvec3(place * at.w, at.w);
    depths[c] = (shot.world_to_camera * dvec4(glm::dvec3(face.now[static_cast<std::size_t>(c)]), 1)).z;
  }
  const dvec2 last(surfaces.width - 1, surfaces.height - 1);
  low = glm::clamp(glm::floor(low - 1.0), dvec2(0), last + 1.0),
  high = glm::clamp(glm::ceil(high), dvec2(-1), last);
  const glm::dmat3 inverse = glm::inverse(corners);
  for (int y = static_cast<int>(low.y); y <= static_cast<int>(high.y); ++y)
    for (int x = static_cast<int>(low.x); x <= static_cast<int>(high.x); ++x) {
      const auto i = static_cast<std::size_t>(y) * static_cast<std::size_t>(surfaces.width) +
                     static_cast<std::size_t>(x);
      const float* pixel = &surfaces.data[static_cast<std::size_t>(surfaces.channels) * i];
      if (static_cast<int>(pixel[4]) != object) continue;
      const glm::dvec3 weights = inverse * glm::dvec3(x + 0.5, y + 0.5, 1);
      const double sum = weights.x + weights.y + weights.z;
      const glm::dvec3 shares = weights / sum;
      if (!(std::min({shares.x, shares.y, shares.z}) >= -1e-4)) continue;
      const double off = std::abs(glm::dot(shares, depths) - double(pixel[0]));
      if (off < pixels[i].off) pixels[i] = {&face, shares, off};
    }
}

/// For each pixel, the face it shows of a mesh that changes shape, if any.
std::vector<Covering> moving_pixels(const Image& surfaces, const Shot& shot, const Region& shown) {
  std::vector<Covering> pixels(surfaces.data.size() / static_cast<std::size_t>(surfaces.channels));
  for (const auto& [object, faces] : shot.next->faces)
    for (const MovingFace& face : faces) cover(surfaces, shot, shown, object, face, pixels);
  return pixels;
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
  const std::vector<Covering> moving = moving_pixels(surfaces, shot, shown);
  Image motion(surfaces.width, surfaces.height, 2);
  for (std::size_t i = 0; i < motion.data.size() / 2; ++i) {
    const float* pixel = &surfaces.data[static_cast<std::size_t>(surfaces.channels) * i];
    const auto width = static_cast<std::size_t>(surfaces.width);
    const dvec2 place = corner + dvec2(i % width, i / width) + 0.5;
    dvec4 world = seen(shot, world_from_ndc, place / size, double(pixel[0]));
    const auto moves = shot.next->moves.find(static_cast<int>(pixel[4]));
    if (moves != shot.next->moves.end()) world = moves->second * world;
    if (const MovingFace* face = moving[i].face) {
      world = dvec4(0, 0, 0, 1);
      for (int c = 0; c < 3; ++c)
        world += dvec4(moving[i].shares[c] * glm::dvec3(face->next[static_cast<std::size_t>(c)]), 0);
    }
    const dvec4 next = shot.next->world_to_ndc * world;
    if (!(next.w > 0)) continue;
    const dvec2 way = dvec2(next) / next.w * size - place;
    motion.data[2 * i] = static_cast<float>(way.x);
    motion.data[2 * i + 1] = static_cast<float>(-way.y);
  }
  found->second = std::move(motion);
}

}  // namespace sundog
