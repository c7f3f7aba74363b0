// Snell and Fresnel for smooth interfaces and unpolarised light.
#include "plain/core.h"

// Cosine of the refracted angle, 0 under total internal reflection. `eta` is the transmitted over the
// incident index, cos_i the cosine of incidence in [0, 1].
static inline float refracted_cosine(float cos_i, float eta) {
  return real_sqrt(real_max(1.0f - (1.0f - cos_i * cos_i) / (eta * eta), 0.0f));
}

// Reflectance of a dielectric interface (Born and Wolf, section 1.5.2); 1 under total internal reflection,
// exactly 0 for eta = 1.
static inline float fresnel_reflectance(float cos_i, float cos_t, float eta) {
  const float parallel = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
  const float perpendicular = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
  const float f = 0.5f * (parallel * parallel + perpendicular * perpendicular);
  return eta == 1.0f ? 0.0f : cos_t <= 0.0f ? 1.0f : f;
}

// d is unit; n is unit and against d.
static inline float3 reflect_direction(float3 d, float3 n) {
  return renormalized3(along(d, -2.0f * dot(d, n), n));
}
static inline float3 refract_direction(float3 d, float3 n, float cos_i, float cos_t, float eta) {
  return renormalized3(along(d * (1.0f / eta), cos_i / eta - cos_t, n));
}
