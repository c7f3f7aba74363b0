// A sampled direction to a light of any kind.
#include "plain/core.h"

CONSTANT float SHORT_OF_LIGHT;

typedef struct LightSample {
  float3 wi;        // unit, from the surface to the light
  float3 radiance;  // before shadowing; of a delta light the irradiance, over pi, on a surface that faces it
  float distance;   // infinite for a light infinitely far away
  float pdf;        // of wi, per steradian; of a delta light 1
  bool delta;       // all light comes along wi: no other way of sampling finds it
} LightSample;

// What a sample counts for, times pi BSDF cos: see bsdf_eval() for the units.
ENTRY static inline float light_weight(const LightSample* light) {
  if (!HAS_AREA_LIGHTS) return 1.0f;
  return light->delta ? 1.0f : 1.0f / (M_PI_F * light->pdf);
}
