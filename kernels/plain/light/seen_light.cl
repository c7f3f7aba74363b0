// The irradiance of a rectangle that nothing hides. A point a lane.
#pragma once
#include "lib/light/light.cl"

// The angle between unit vectors whose cosine is x, over its sine: a polynomial on Chebyshev's nodes in
// [0, 1] (error 3e-7), and the supplement below.
static inline REAL angle_over_sine(REAL x) {
  const REAL y = 1.0f - real_min(fabs(x), (REAL)(1.0f));
  REAL f = fma(y, (REAL)(0.0176536683f), (REAL)(-0.0432606409f));
  f = fma(y, f, (REAL)(0.0617602527f));
  f = fma(y, f, (REAL)(-0.026127294f));
  f = fma(y, f, (REAL)(0.039620386f));
  f = fma(y, f, (REAL)(0.0541928006f));
  f = fma(y, f, (REAL)(0.133635433f));
  f = fma(y, f, (REAL)(0.333321541f));
  f = fma(y, f, (REAL)(1.0f));
  const REAL sine2 = real_max(y * (2.0f - y), (REAL)(1e-12f));
  return select(f, fma((REAL)(M_PI_F), real_rsqrt(sine2), -f), MASK_OF(x < 0.0f));
}

// The term of a polygon's side, from the unit vector a to b, in twice the integral of the cosine to n.
static inline REAL cosine_of_side(REAL3 a, REAL3 b, REAL3 n) {
  return angle_over_sine(dot3(a, b)) * dot3(cross3(a, b), n);
}

// The integral of the cosine to n over the directions above the horizon in which the corners' polygon is
// seen (Lambert 1760; the sides cut at the horizon, and closed along it). Returns the lanes where its sum is
// no small difference of great terms.
static inline MASK cosine_of_polygon(const REAL3* corner, REAL3 n, REAL* integral) {
  REAL3 v[4];
  REAL z[4];
#pragma unroll
  for (u32 i = 0; i < 4u; ++i) {
    v[i] = safe_unit3(corner[i]);
    z[i] = dot3(n, v[i]);
  }
  REAL sum = (REAL)(0.0f), size = sum;
  REAL3 rises = v[0], sets = v[0];
  MASK cut = NO_LANES;
#pragma unroll
  for (u32 i = 0; i < 4u; ++i) {
    const REAL3 a = v[i], b = v[(i + 1u) & 3u];
    const REAL za = z[i], zb = z[(i + 1u) & 3u];
    const MASK above = MASK_OF(za > 0.0f), next_above = MASK_OF(zb > 0.0f), crosses = above ^ next_above;
    REAL3 from = a, to = b;
    if (any_lane(crosses)) {
      const REAL3 way = select3(subtract3(scale3(b, za), scale3(a, zb)),
                                subtract3(scale3(a, zb), scale3(b, za)), next_above);
      const REAL3 horizon = safe_unit3(way);
      from = select3(a, horizon, crosses & next_above);
      to = select3(b, horizon, crosses & above);
      rises = select3(rises, horizon, crosses & next_above);
      sets = select3(sets, horizon, crosses & above);
      cut |= crosses;
    }
    const REAL term = select((REAL)(0.0f), cosine_of_side(from, to, n), above | next_above);
    sum += term;
    size += fabs(term);
  }
  if (any_lane(cut)) {
    const REAL term = select((REAL)(0.0f), cosine_of_side(sets, rises, n), cut);
    sum += term;
    size += fabs(term);
  }
  *integral = 0.5f * fabs(sum);
  return MASK_OF(fabs(sum) >= 1e-3f * size);
}

// A light that takes up less than this part of its distance is integrated at four places.
#define FAR_PART 0.05f

// The integral for a rectangle far away with nothing below the horizon: by Gauss and Legendre's two places
// along each side.
static inline MASK cosine_of_far_rectangle(__global const Light* light, const REAL3* corner, REAL3 n,
                                           REAL* integral) {
  const float places[2] = {0.211324865f, 0.788675135f};
  const float3 first = light->edge_u.xyz, second = light->edge_v.xyz;
  const REAL quarter = (REAL)(0.25f * light->direction.w);
  MASK far = ALL_LANES;
  REAL sum = (REAL)(0.0f);
  for (u32 i = 0; i < 4u; ++i) {
    const REAL3 to = add3(corner[0], all3(places[i & 1u] * first + places[i >> 1] * second));
    const REAL3 wi = safe_unit3(to);
    sum -= dot3(n, wi) * dot3(all3(light->direction.xyz), wi) * (quarter / dot3(to, to));
    far &= MASK_OF(dot3(n, corner[i]) > 0.0f);
  }
  *integral = sum;
  return far &
         MASK_OF(dot(first, first) + dot(second, second) < FAR_PART * FAR_PART * dot3(corner[0], corner[0]));
}

// The integral for a rectangle anywhere, for `lanes`. Returns those where it is known.
static inline MASK cosine_of_rectangle(__global const Light* light, const SeenLights* seen, REAL3 n,
                                       MASK lanes, REAL* integral) {
  const MASK known = lanes & cosine_of_polygon(seen->corner, n, integral), open = lanes & ~known;
  if (!any_lane(open)) return known;
  REAL from_afar;
  const MASK far = open & cosine_of_far_rectangle(light, seen->corner, n, &from_afar);
  *integral = select(*integral, from_afar, far);
  return known | far;
}
