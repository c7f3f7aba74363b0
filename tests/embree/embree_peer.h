// A scene's meshes and balls under Embree, and its answers for given rays: what the tracer is held against,
// for hits and for speed.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "compile/compiled_scene.h"

namespace sundog {

/// Embree's hit of a ray. `object` is the scene's object, `prim` the triangle of its mesh or 0; NO_PRIM:
/// no hit.
struct EmbreeHit {
  float t = 0, u = 0, v = 0;
  u32 prim = NO_PRIM, object = NO_INSTANCE;
};

enum class EmbreeWidth { single, packet16 };

struct EmbreeOptions {
  bool robust = false;  // watertight tests
};

class EmbreePeer {
 public:
  /// Builds the BVH. The scene must outlive it. Throws SceneError where an object is neither a mesh nor a
  /// ball.
  explicit EmbreePeer(const SceneDescription& scene, const EmbreeOptions& options = {});
  ~EmbreePeer();

  double build_seconds() const;

  /// Nearest hits in [t_min, t_max], on `threads` threads. Coherent: 16 rays in a row run close together.
  void intersect(std::span<const Ray> rays, std::span<EmbreeHit> hits, unsigned threads,
                 EmbreeWidth width = EmbreeWidth::single, bool coherent = false) const;
  /// 1 where something is hit, else 0.
  void occluded(std::span<const Ray> rays, std::span<u32> result, unsigned threads,
                EmbreeWidth width = EmbreeWidth::single, bool coherent = false) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace sundog
