// Checks a tracer's answers. The plain C++ tracer (bench/plain: floats, none of the kernels' code) traces
// each ray as well; where the two differ, double precision decides.
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
  std::size_t checked = 0;  // all rays
  std::size_t rounded = 0;  // differ from the plain tracer's answer, but right within rounding
  std::size_t differ = 0;   // wrong
};

/// Checks every ray, on all cores. An answer is right if it is the plain tracer's (the same instance or none,
/// the distance within a relative 1e-4) or if is_right() accepts it. After a thousand wrong answers, all
/// further answers that differ from the plain tracer's count as wrong.
HitCheck check_hits(const CompiledScene& scene, const RaySet& set, const Answers& answers);

/// Whether a hit (NO_INSTANCE: none) is right within rounding. Traces the ray and copies of it, moved
/// sideways and along by the rounding error of floats, in double precision: the hit must lie between their
/// nearest and their farthest (none: infinitely far), and one of them must meet the named instance there.
/// Copies disagree only at silhouettes, at creases seen edge-on and at the ends of the ray's interval, where
/// rounding decides.
bool is_right(const CompiledScene& scene, const Ray& ray, const Hit& hit);

/// Whether `occluded` is right within rounding.
bool is_right(const CompiledScene& scene, const Ray& ray, bool occluded);

}  // namespace sundog
