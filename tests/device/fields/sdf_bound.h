// Whether a field's estimate is ever longer than the way to its surface, for tests.
#pragma once
#include <algorithm>
#include <vector>

#include "compile/fields/held_bailout.h"
#include "formula/evaluate.h"
#include "sdf_testing.h"

// From random points towards the surface and to its sides, by steps of a seventh of the estimate: where
// another estimate says that the surface is reached before the first one's length, that length was too long.
// Writes the least ratio of the two.
inline const char* const bound_kernel = R"(
#include "lib/sdf/surface.cl"
static inline float uniform01(u32 x) {
  x ^= x >> 16; x *= 0x7feb352du; x ^= x >> 15; x *= 0x846ca68bu; x ^= x >> 16;
  return (float)(x >> 8) * 0x1p-24f;
}
static inline REAL3 random_directions(REAL3 middle, float spread, u32 seed) {
  REAL3 d = middle;
  for (u32 i = 0; i < LANES; ++i) {
    REAL_LANE(d.x, i) += spread * (2.0f * uniform01(seed + 16u * i) - 1.0f);
    REAL_LANE(d.y, i) += spread * (2.0f * uniform01(seed + 16u * i + 1u) - 1.0f);
    REAL_LANE(d.z, i) += spread * (2.0f * uniform01(seed + 16u * i + 2u) - 1.0f);
  }
  return unit3(d);
}
__kernel void bound(__global const SdfField* fields, __global const float* q, __global float* ratios, __global float4* places, u32 field, u32 count) {
  const u32 item = get_global_id(0);
  if (item * LANES >= count) return;
  __global const SdfField* f = fields + field;
  REAL3 p;
  for (u32 i = 0; i < LANES; ++i) {
    const u32 s = (item * LANES + i) * 16u;
    REAL_LANE(p.x, i) = mix(f->lower.x, f->upper.x, uniform01(s));
    REAL_LANE(p.y, i) = mix(f->lower.y, f->upper.y, uniform01(s + 1u));
    REAL_LANE(p.z, i) = mix(f->lower.z, f->upper.z, uniform01(s + 2u));
  }
  const REAL first = sdf_distance(field, p, ALL_LANES, q);
  const REAL3 ahead = unit3(negate3(sdf_sample(field, p, q).gradient));
  REAL ratio = (REAL)(1.0f);
  for (u32 k = 0; k < 3u; ++k) {
    const REAL3 d = k == 0u ? ahead : random_directions(ahead, k == 1u ? 0.7f : 2.0f, item * LANES * 16u + 3u * k);
    REAL t = (REAL)(0.0f), here = first;
    MASK active = MASK_OF(first > 1e-4f);
    for (u32 i = 0; i < 64u && any_lane(active); ++i) {
      t = select(t, t + fmax(0.15f * here, first * 0.01f), active);
      active &= MASK_OF(t < first);
      here = sdf_distance(field, along3(p, t, d), active, q);
      const MASK reached = active & MASK_OF(here < 0.003f * first);
      ratio = select(ratio, fmin(ratio, t / first), reached);
      active &= ~reached;
    }
  }
  for (u32 i = 0; i < LANES; ++i) {
    ratios[item * LANES + i] = REAL_LANE(ratio, i);
    places[item * LANES + i] = (float4)(REAL_LANE(p.x, i), REAL_LANE(p.y, i), REAL_LANE(p.z, i), REAL_LANE(first, i));
  }
}
)";

class BoundTester {
 public:
  BoundTester(sundog::Device& device, const sundog::CompiledFields& fields)
      : device_(device),
        kernel_(build_fields(device, bound_kernel, fields, 16)
                    .kernel<Records, Floats, Floats, Places, u32, u32>("bound")),
        records_(device.upload<sundog::SdfField>(fields.fields)),
        parameters_(device.upload<float>(fields.parameters)) {}

  /// Ratios of the distance to the surface and the estimate, at most 1, in ascending order, from `count` (a
  /// multiple of 16) random points.
  std::vector<float> ratios(sundog::u32 field, sundog::u32 count) {
    auto out = device_.make<float>(count);
    auto places = device_.make<sundog::float4>(count);
    device_.run(kernel_, {.x = count / 16, .local_x = 16}, records_, parameters_, out, places, field, count);
    std::vector<float> found(count);
    places_.resize(count);
    device_.read(out, std::span<float>(found));
    device_.read(places, std::span<sundog::float4>(places_));
    device_.finish();
    std::sort(found.begin(), found.end());
    return found;
  }
  /// The points of the last call; w: the estimates there.
  const std::vector<sundog::float4>& places() const { return places_; }

 private:
  using u32 = sundog::u32;
  using Records = sundog::Buffer<sundog::SdfField>;
  using Floats = sundog::Buffer<float>;
  using Places = sundog::Buffer<sundog::float4>;
  sundog::Device& device_;
  sundog::Kernel<Records, Floats, Floats, Places, u32, u32> kernel_;
  Records records_;
  Floats parameters_;
  std::vector<sundog::float4> places_;
};

/// `exceptions`: the share of the points where the estimate may be too long, by a factor of 1.8 in a tenth of
/// them; by any factor where `depths`, which are no proven bound, are asked for.
inline void check_bound(const std::vector<float>& ratios, double exceptions, bool any_length = false) {
  const auto count = static_cast<double>(ratios.size());
  // the walk's own grain is 1 %
  CHECK(ratios[static_cast<std::size_t>(exceptions * count)] > 0.98f);
  if (!any_length)
    CHECK(ratios[static_cast<std::size_t>(0.1 * exceptions * count)] > (exceptions > 0 ? 0.55f : 0.98f));
}

/// A formula's estimates are what doubles give, who have room for every orbit: neither longer nor shorter.
inline void check_against_doubles(const std::vector<sundog::float4>& places, sundog::FormulaField formula) {
  formula.bailout = sundog::held_bailout(formula);  // where the last iteration's surface is
  sundog::FormulaEvaluator evaluator(formula);
  std::size_t compared = 0, shorter = 0, longer = 0;
  for (std::size_t i = 0; i < places.size() && compared < 400; ++i) {
    const sundog::float4& p = places[i];
    const auto expected = evaluator.at({double(p.x), double(p.y), double(p.z)});
    if (expected.inside || !(expected.distance > 1e-3) || !(expected.distance < 1e3)) continue;
    ++compared;
    shorter += double(p.w) < 0.9 * expected.distance;
    longer += double(p.w) > 1.1 * expected.distance;
  }
  CHECK(shorter <= compared / 50);  // on the poles of powers
  CHECK(longer <= compared / 50);
}
