// Axis-aligned boxes for the BVH builder: four lanes per corner, so that one instruction handles x, y and z.
#pragma once
#include <bit>
#include <limits>

#include "shared/types.h"

namespace sundog {

using Lanes = float __attribute__((vector_size(16)));
using IntLanes = i32 __attribute__((vector_size(16)));

inline Lanes lanes(float value) { return Lanes{value, value, value, value}; }
inline Lanes lanes_min(Lanes a, Lanes b) { return a < b ? a : b; }
inline Lanes lanes_max(Lanes a, Lanes b) { return a > b ? a : b; }

/// A box. The fourth lane of each corner is free for the owner. Uninitialised, because the builder creates
/// many that it does not use.
struct Bounds {
  Lanes lower, upper;

  static Bounds none() {
    constexpr float inf = std::numeric_limits<float>::infinity();
    return {lanes(inf), lanes(-inf)};
  }

  void extend(const Bounds& other) {
    lower = lanes_min(lower, other.lower);
    upper = lanes_max(upper, other.upper);
  }
  void extend(Lanes point) {
    lower = lanes_min(lower, point);
    upper = lanes_max(upper, point);
  }
  bool empty() const { return !(lower[0] <= upper[0]); }
};

/// Half the surface area of a non-empty box scaled by `scale`, so that boxes of size 1e30 do not overflow. A
/// trace of the sum of edges distinguishes flat and thin boxes.
inline float half_area(const Bounds& box, float scale) {
  const Lanes edge = (box.upper - box.lower) * lanes(scale);
  return edge[0] * (edge[1] + edge[2]) + edge[1] * edge[2] + 1e-6f * (edge[0] + edge[1] + edge[2]);
}

/// A primitive's box, which the builder sorts, with the primitive's index in the fourth lane of `lower`.
/// `bias` makes the index a normal float, because denormals in the spare lane would slow arithmetic.
struct Ref {
  Bounds box;

  static constexpr u32 bias = 0x40000000u;
  static Ref of(const Bounds& bounds, u32 prim) {
    Ref ref{bounds};
    // turn -0 into +0, because the minimum of both would depend on their order
    ref.box.lower = ref.box.lower + lanes(0.0f);
    ref.box.upper = ref.box.upper + lanes(0.0f);
    ref.box.lower[3] = std::bit_cast<float>(prim + bias);
    ref.box.upper[3] = 0;
    return ref;
  }
  u32 prim() const { return std::bit_cast<u32>(float(box.lower[3])) - bias; }
  /// Twice the box's centre.
  Lanes center2() const { return box.lower + box.upper; }
};
static_assert(sizeof(Ref) == 32);

}  // namespace sundog
