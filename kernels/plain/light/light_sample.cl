// The results of every light's functions: a sampled direction, the light seen from a point, a photon's start.
#include "plain/path/directions.cl"

typedef struct LightSample {
  float3 wi;        // unit, from the surface to the light
  float3 radiance;  // before shadowing; of a delta light the irradiance, over pi, on a surface that faces it
  float distance;   // infinite for a light infinitely far away
  float pdf;        // of wi, per steradian; of a delta light 1
  bool delta;       // all light comes along wi: no other way of sampling finds it
} LightSample;

// A square around an area light, as a point sees it.
typedef struct SeenLight {
  float3 corner[4];  // from the point to the corners, in turn
  bool in_front;     // the light shines on the point, from a place that is clearly before it
  bool behind;       // it shines away from the point
} SeenLight;

static inline SeenLight seen_square(float3 to, float3 u, float3 v, bool in_front, bool behind) {
  SeenLight seen;
  seen.corner[0] = to;
  seen.corner[1] = to + u;
  seen.corner[2] = seen.corner[1] + v;
  seen.corner[3] = to + v;
  seen.in_front = in_front;
  seen.behind = behind;
  return seen;
}

// A photon as it leaves a light.
typedef struct Emission {
  float3 p, n;      // of a light that has a position: a place on it, and the normal there
  float3 d;         // of light from afar: its direction
  float3 radiance;  // times pi of a directional light; of a sun over the density of d
  float area;       // of an area light
} Emission;

static inline Emission emit_from(float3 p, float3 n, float3 radiance, float area) {
  const Emission emission = {p, n, (float3)(0.0f), radiance, area};
  return emission;
}
static inline Emission emit_along(float3 d, float3 radiance) {
  const Emission emission = {(float3)(0.0f), (float3)(0.0f), d, radiance, 0.0f};
  return emission;
}

// A sample's weight, to be multiplied by pi BSDF cos. The radiance of a delta light is its irradiance / pi.
ENTRY static inline float light_weight(const LightSample* light) {
  if (!HAS_AREA_LIGHTS) return 1.0f;
  return light->delta ? 1.0f : 1.0f / (M_PI_F * light->pdf);
}
