// Whitted's integrator (1980) as a plain C++ program: one thread, recursion, scalar floats, no OpenCL and
// none of the kernels' code. What devices are timed against; it draws the same picture but for rounding.
#pragma once
#include <string>

#include "base/image.h"
#include "bench/plain/media.h"
#include "bench/plain/tracer.h"
#include "compile/compiled_scene.h"
#include "render/plan/tiles.h"
#include "render/render.h"

namespace sundog {

/// Why it cannot draw the scene; empty: it can.
std::string plain_refusal(const CompiledScene& scene);

/// Why a picture of it is not the device's but for rounding (rays at silhouettes and checkers fall to either
/// side); empty: it is.
std::string plain_difference(const Image& plain, const Image& device);

/// A frame in parts, its hits found by whatever finder, for threads of a caller's own. Scene and finder must
/// outlive it.
class PlainFrame {
 public:
  PlainFrame(const CompiledScene& scene, const plain::HitFinder& finder);

  /// Writes the tile's pixels and adds its rays to `counts`.
  void render(const Tile& tile, Image& image, RayCounts& counts) const;

 private:
  const CompiledScene& scene_;
  const plain::HitFinder& finder_;
  plain::MediaStack media_;  // that hold the camera
};

/// The whole frame. Linear RGBA, alpha is coverage. The scene is one that plain_refusal() has nothing
/// against.
Image render_plain(const CompiledScene& scene);

}  // namespace sundog
