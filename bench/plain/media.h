// The media that a ray is inside of, after Schmidt and Budge (2002): the highest priority wins, of equal ones
// the medium entered last. As the kernels have it, up to eight at once.
#pragma once
#include <array>
#include <glm/glm.hpp>

#include "compile/compiled_scene.h"

namespace sundog::plain {

class MediaStack {
 public:
  /// False when that cannot be: the stack is full, or the medium was never entered.
  bool cross(u32 medium, bool entering);

  /// The medium that light is in; 0 is the world's.
  u32 current(const CompiledScene& scene) const;

  /// Puts a medium below all others: one that was entered before them.
  void put_under(u32 medium);

 private:
  std::array<u32, 8> media_{};  // in order of entry
  std::size_t count_ = 0;
};

/// Beer and Lambert: the part of light that passes `distance`.
glm::vec3 absorb(const CompiledScene& scene, u32 medium, float distance);

}  // namespace sundog::plain
