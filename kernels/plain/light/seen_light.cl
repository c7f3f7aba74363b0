// The irradiance of a rectangle that nothing hides.
#include "plain/light/light.cl"

HAVING(HAS_AREA_LIGHTS);

// The angle between unit vectors whose cosine is x, over its sine: a polynomial on Chebyshev's nodes in
// [0, 1] (error 3e-7), and the supplement below.
static inline float angle_over_sine(float x) {
  const float y = 1.0f - real_min(fabs(x), 1.0f);
  float f = fma(y, 0.0176536683f, -0.0432606409f);
  f = fma(y, f, 0.0617602527f);
  f = fma(y, f, -0.026127294f);
  f = fma(y, f, 0.039620386f);
  f = fma(y, f, 0.0541928006f);
  f = fma(y, f, 0.133635433f);
  f = fma(y, f, 0.333321541f);
  f = fma(y, f, 1.0f);
  const float sine2 = real_max(y * (2.0f - y), 1e-12f);
  return x < 0.0f ? fma(M_PI_F, real_rsqrt(sine2), -f) : f;
}

// The term of a polygon's side, from the unit vector a to b, in twice the integral of the cosine to n.
static inline float cosine_of_side(float3 a, float3 b, float3 n) {
  return angle_over_sine(dot(a, b)) * dot(cross(a, b), n);
}

// The integral of the cosine to n over the directions above the horizon in which the corners' polygon is seen
// (Lambert 1760; the sides cut at the horizon, and closed along it). Whether its sum is no small difference
// of great terms.
static inline bool cosine_of_polygon(const SeenLight* seen, float3 n, float* integral) {
  float3 v[4];
  float z[4];
  for (u32 i = 0; i < 4u; ++i) {
    v[i] = safe_unit3(seen->corner[i]);
    z[i] = dot(n, v[i]);
  }
  float sum = 0.0f, size = 0.0f;
  float3 rises = v[0], sets = v[0];
  bool cut = false;
  for (u32 i = 0; i < 4u; ++i) {
    const float3 a = v[i], b = v[(i + 1u) & 3u];
    const float za = z[i], zb = z[(i + 1u) & 3u];
    const bool above = za > 0.0f, next_above = zb > 0.0f;
    float3 from = a, to = b;
    if (above != next_above) {
      const float3 horizon = safe_unit3(next_above ? a * zb - b * za : b * za - a * zb);
      if (next_above) {
        from = horizon;
        rises = horizon;
      } else {
        to = horizon;
        sets = horizon;
      }
      cut = true;
    }
    const float term = above || next_above ? cosine_of_side(from, to, n) : 0.0f;
    sum += term;
    size += fabs(term);
  }
  if (cut) {
    const float term = cosine_of_side(sets, rises, n);
    sum += term;
    size += fabs(term);
  }
  *integral = 0.5f * fabs(sum);
  return fabs(sum) >= 1e-3f * size;
}

// A light that takes up less than this part of its distance is integrated at four places.
#define FAR_PART 0.05f

// The integral for a rectangle far away with nothing below the horizon: by Gauss and Legendre's two places
// along each side.
static inline bool cosine_of_far_rectangle(UNIFORM __global const Light* light, const SeenLight* seen,
                                           float3 n, float* integral) {
  const float3 first = light->edge_u.xyz, second = light->edge_v.xyz;
  const float quarter = 0.25f * light->direction.w;
  bool far = true;
  float sum = 0.0f;
  for (u32 i = 0; i < 4u; ++i) {
    const float across = (i & 1u) != 0u ? 0.788675135f : 0.211324865f,
                down = i > 1u ? 0.788675135f : 0.211324865f;
    const float3 to = seen->corner[0] + (across * first + down * second);
    const float3 wi = safe_unit3(to);
    sum -= dot(n, wi) * dot(light->direction.xyz, wi) * (quarter / dot(to, to));
    far = far && dot(n, seen->corner[i]) > 0.0f;
  }
  *integral = sum;
  return far && dot(first, first) + dot(second, second) <
                    FAR_PART * FAR_PART * dot(seen->corner[0], seen->corner[0]);
}

// The integral for a rectangle anywhere. Whether it is known.
static inline bool cosine_of_rectangle(UNIFORM __global const Light* light, const SeenLight* seen, float3 n,
                                       float* integral) {
  if (cosine_of_polygon(seen, n, integral)) return true;
  return cosine_of_far_rectangle(light, seen, n, integral);
}
