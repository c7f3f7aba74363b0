// Snell and Fresnel for smooth interfaces, unpolarised light.
#ifndef SUNDOG_LIB_OPTICS_CL
#define SUNDOG_LIB_OPTICS_CL
#include "lib/config.h"
#include "lib/transform.cl"

// Cosine of the refracted angle, 0 under total internal reflection. `eta` is the index of the medium that
// transmits over that of the incident one, cos_i the cosine of incidence in [0, 1].
static inline float refracted_cosine(float cos_i, float eta) {
  const float sin2_t = (1.0f - cos_i * cos_i) / (eta * eta);
  return sin2_t < 1.0f ? sqrt(1.0f - sin2_t) : 0.0f;
}

// Reflectance of a dielectric interface (Born and Wolf, section 1.5.2); 1 under total internal reflection,
// exactly 0 for eta = 1.
static inline float fresnel_reflectance(float cos_i, float cos_t, float eta) {
  if (eta == 1.0f) return 0.0f;
  if (cos_t <= 0.0f) return 1.0f;
  const float parallel = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
  const float perpendicular = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
  return 0.5f * (parallel * parallel + perpendicular * perpendicular);
}

// d unit, n unit and against d.
static inline float3 reflect_direction(float3 d, float3 n) { return renormalized(d - 2.0f * dot(d, n) * n); }

static inline float3 refract_direction(float3 d, float3 n, float cos_i, float cos_t, float eta) {
  return renormalized(d / eta + (cos_i / eta - cos_t) * n);
}

#endif
