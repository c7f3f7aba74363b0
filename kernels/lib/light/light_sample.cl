// A way to a light, as every kind of light gives it. A point a lane.
#ifndef SUNDOG_LIB_LIGHT_SAMPLE_CL
#define SUNDOG_LIB_LIGHT_SAMPLE_CL
#include "lib/core/lanes.h"

typedef struct LightSamples {
  REAL3 wi;        // unit, from the surface to the light
  REAL distance;   // infinite for a light infinitely far away
  REAL3 radiance;  // before shadowing; of a delta light the irradiance, over pi, on a surface that faces it
  REAL pdf;        // of wi, per steradian; of a delta light 1
  MASK delta;      // all light comes along wi: no other way of sampling finds it
} LightSamples;

// What a sample counts for, times pi BSDF cos: see bsdf_eval() for the units.
static inline REAL light_weight(const LightSamples* light) {
  if (!HAS_AREA_LIGHTS) return (REAL)(1.0f);
  return select(1.0f / (M_PI_F * light->pdf), (REAL)(1.0f), light->delta);
}

#endif
