// Keeps media in an array by order of entry and searches it from the end; absorption is Beer's law.
#include "bench/plain/media.h"

#include <algorithm>
#include <cmath>

#include "bench/plain/surface.h"

namespace sundog::plain {

bool MediaStack::cross(u32 medium, bool entering) {
  if (entering) {
    if (count_ == media_.size()) return false;
    media_[count_++] = medium;
    return true;
  }
  for (std::size_t i = count_; i-- > 0;) {
    if (media_[i] != medium) continue;
    std::copy(media_.begin() + static_cast<std::ptrdiff_t>(i) + 1,
              media_.begin() + static_cast<std::ptrdiff_t>(count_),
              media_.begin() + static_cast<std::ptrdiff_t>(i));
    --count_;
    return true;
  }
  return false;
}

u32 MediaStack::current(const CompiledScene& scene) const {
  if (count_ == 0) return 0;
  u32 best = media_[count_ - 1];
  for (std::size_t i = count_; i-- > 0;)
    if (scene.media[media_[i]].priority > scene.media[best].priority) best = media_[i];
  return best;
}

void MediaStack::put_under(u32 medium) {
  if (count_ == media_.size()) return;
  std::copy_backward(media_.begin(), media_.begin() + static_cast<std::ptrdiff_t>(count_),
                     media_.begin() + static_cast<std::ptrdiff_t>(count_) + 1);
  media_[0] = medium;
  ++count_;
}

glm::vec3 absorb(const CompiledScene& scene, u32 medium, float distance) {
  const glm::vec3 a = rgb(scene.media[medium].absorption);
  glm::vec3 left;
  for (int i = 0; i < 3; ++i) left[i] = a[i] == 0 ? 1 : std::exp(-a[i] * distance);
  return left;
}

}  // namespace sundog::plain
