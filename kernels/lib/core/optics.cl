// Snell and Fresnel for smooth interfaces and unpolarised light, one ray per lane.
#pragma once
#include "lib/core/lanes.h"

// Cosine of the refracted angle, 0 under total internal reflection. `eta` is the transmitted over the
// incident index, cos_i the cosine of incidence in [0, 1].
static inline REAL refracted_cosine(REAL cos_i, REAL eta) {
  const REAL square = 1.0f - (1.0f - cos_i * cos_i) / (eta * eta);
  return real_sqrt(real_max(square, (REAL)(0.0f)));
}

// Reflectance of a dielectric interface (Born and Wolf, section 1.5.2); 1 under total internal reflection,
// exactly 0 for eta = 1.
static inline REAL fresnel_reflectance(REAL cos_i, REAL cos_t, REAL eta) {
  const REAL parallel = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
  const REAL perpendicular = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
  const REAL f = 0.5f * (parallel * parallel + perpendicular * perpendicular);
  return select(select(f, (REAL)(1.0f), MASK_OF(cos_t <= 0.0f)), (REAL)(0.0f), MASK_OF(eta == 1.0f));
}

// d is unit; n is unit and against d.
static inline REAL3 reflect_direction(REAL3 d, REAL3 n) {
  return renormalized3(along3(d, -2.0f * dot3(d, n), n));
}

static inline REAL3 refract_direction(REAL3 d, REAL3 n, REAL cos_i, REAL cos_t, REAL eta) {
  return renormalized3(along3(scale3(d, 1.0f / eta), cos_i / eta - cos_t, n));
}
