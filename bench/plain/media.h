// The media that a ray is inside of, after Schmidt and Budge (2002): the highest priority wins; among equals,
// the medium entered last. Up to eight at once, as in the kernels.
#pragma once
#include <array>
#include <glm/glm.hpp>

#include "compile/compiled_scene.h"

namespace sundog::plain {

class MediaStack {
 public:
  /// Enters or leaves a medium. False if the stack is full or the medium was never entered.
  bool cross(u32 medium, bool entering);

  /// The medium that light is in; 0 is the world's.
  u32 current(const CompiledScene& scene) const;

  /// Puts a medium below all others, as if it had been entered first. Does nothing if the stack is full.
  void put_under(u32 medium);

 private:
  std::array<u32, 8> media_{};  // in order of entry
  std::size_t count_ = 0;
};

/// Beer and Lambert's law: the fraction of light that passes `distance`.
glm::vec3 absorb(const CompiledScene& scene, u32 medium, float distance);

}  // namespace sundog::plain
