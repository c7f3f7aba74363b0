// Hits for the plain integrator by Embree, as a C++ program that cares for speed would have it: the mesh by
// rtcIntersect1 and rtcOccluded1 in a BVH of medium quality, a few exact solids by their equations before.
#pragma once
#include <memory>

#include "bench/plain/tracer.h"

namespace sundog {

class EmbreeFinder : public plain::HitFinder {
 public:
  /// Builds the BVH. `compiled` is `scene` compiled, and must outlive it. Throws SceneError unless the scene
  /// has one mesh, in world space.
  EmbreeFinder(const SceneDescription& scene, const CompiledScene& compiled);
  ~EmbreeFinder() override;

  bool closest(const plain::Ray& ray, plain::Hit& hit) const override;
  bool any(const plain::Ray& ray) const override;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace sundog
