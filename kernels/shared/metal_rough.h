// Metalness and roughness (glTF 2.0, appendix B) in terms of the phong model, for host and device. For base
// colour b, metalness m, roughness r and a dielectric's normal reflectance f:
//   mirror share  k = m (1 - r)^2: only a smooth metal is a mirror
//   reflection    b k
//   highlight     s = f (1 - m) + b m, Blinn with exponent 2 / r^4 - 2 (Karis 2013: alpha = r^2). It
//                 returns s h of uniform light, where h is at most (1 - k) / 2: a rough one is
//                 weaker
//   diffuse       b (1 - k - h (m + f (1 - m))), the rest, and a tenth of it ambient
// Devices take metalness and roughness from textures, the host from numbers.
#pragma once
#include "shared/types.h"

#if defined(__OPENCL_VERSION__) || defined(__OPENCL_C_VERSION__)
#define SUNDOG_METAL_REAL REAL
#define SUNDOG_METAL_CLAMP(x, low, high) real_clamp(x, (REAL)(low), (REAL)(high))
#define SUNDOG_METAL_EXP(x) real_exp(x)
#define SUNDOG_METAL_INLINE static inline
#else
#include <algorithm>
#include <cmath>
#define SUNDOG_METAL_REAL double
#define SUNDOG_METAL_CLAMP(x, low, high) std::clamp<double>(x, double(low), double(high))
#define SUNDOG_METAL_EXP(x) std::exp(x)
#define SUNDOG_METAL_INLINE inline
namespace sundog {
#endif

SUNDOG_METAL_INLINE SUNDOG_METAL_REAL metal_mirror(SUNDOG_METAL_REAL metalness, SUNDOG_METAL_REAL roughness) {
  const SUNDOG_METAL_REAL smooth = 1.0f - roughness;
  return metalness * smooth * smooth;
}

SUNDOG_METAL_INLINE SUNDOG_METAL_REAL rough_exponent(SUNDOG_METAL_REAL roughness) {
  const SUNDOG_METAL_REAL square = roughness * roughness;
  return SUNDOG_METAL_CLAMP(2.0f / SUNDOG_METAL_CLAMP(square * square, 1e-9f, 1.0f) - 2.0f, 1.0f, 1e5f);
}

/// The fraction of uniform white light that max(n.h, 0)^e reflects along n, its maximum.
SUNDOG_METAL_INLINE SUNDOG_METAL_REAL highlight_energy(SUNDOG_METAL_REAL e) {
  return 8.0f * (1.0f - SUNDOG_METAL_EXP(-0.34657359f * (e + 2.0f))) / (e + 2.0f);
}

/// h in the comment above. A mirror keeps its small highlight.
SUNDOG_METAL_INLINE SUNDOG_METAL_REAL metal_highlight(SUNDOG_METAL_REAL energy, SUNDOG_METAL_REAL mirror) {
  return SUNDOG_METAL_CLAMP(0.5f * (1.002f - mirror), 0.0f, energy);
}

#if !defined(__OPENCL_VERSION__) && !defined(__OPENCL_C_VERSION__)
}  // namespace sundog
#endif
