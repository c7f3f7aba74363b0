// Whether a tracer's answers are right. Each ray is traced by the plain C++ tracer as well (bench/plain:
// floats, none of the kernels' code); where the two differ, double precision decides.
#pragma once

#include "bench/rays/ray_sets.h"

namespace sundog {

/// A device's answers, in the order of the rays: `occluded` alone for sets that ask for any hit, else `hits`.
struct Answers {
  std::vector<Hit> hits;
  std::vector<u32> occluded;
};

struct HitCheck {
  std::size_t hits = 0;     // rays that hit something
  std::size_t checked = 0;  // all of them
  std::size_t rounded = 0;  // another answer than the plain tracer's, and right within rounding
  std::size_t differ = 0;   // wrong
};

/// Checks every ray, on all cores. An answer is right when it is the plain tracer's (hit or none, the
/// distance to 1e-4), or when is_right() says so. After a thousand wrong answers the rest of those that
/// differ from the plain tracer's count as wrong unseen.
HitCheck check_hits(const CompiledScene& scene, const RaySet& set, const Answers& answers);

/// Whether a hit (NO_INSTANCE: none) is right within rounding. The ray and its copies that are moved by what
/// floats round, sideways and along, are traced in double precision: the answer must lie between the nearest
/// and the farthest of theirs (none: infinitely far), and the instance that is named must be met there.
/// Copies agree but at silhouettes, at creases seen edge-on and at the ends of the ray's interval, where
/// rounding decides.
bool is_right(const CompiledScene& scene, const Ray& ray, const Hit& hit);

/// Whether `occluded` is right within rounding.
bool is_right(const CompiledScene& scene, const Ray& ray, bool occluded);

}  // namespace sundog
