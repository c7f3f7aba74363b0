// Media on the way of a ray.
#include "plain/path/scene_ray.cl"

// The medium that the ray is in.
int current_media(UNIFORM __global const Medium* media, const SceneRay* ray, HERE);

// Beer-Lambert: transmittance over `distance` in a medium.
ENTRY static inline float3 absorb(UNIFORM __global const Medium* media, int medium, float distance) {
  float3 kept = (float3)(1.0f);
  if (HAS_ABSORPTION) EACH_ALIKE(int, index, medium) {
      const float3 a = media[index].absorption.xyz;
      // Unabsorbed colours keep their bits, even over infinite distances.
      if (a.x != 0.0f) kept.x = real_exp(-a.x * distance);
      if (a.y != 0.0f) kept.y = real_exp(-a.y * distance);
      if (a.z != 0.0f) kept.z = real_exp(-a.z * distance);
    }
  return kept;
}

static inline float refraction_index(UNIFORM __global const Medium* media, int medium) {
  float index = 1.0f;
  EACH_ALIKE(int, at, medium) index = media[at].absorption.w;
  return index;
}

// Refractive index behind an interface over that before it.
ENTRY static inline float relative_index(UNIFORM __global const Medium* media, int before, int after) {
  if (!HAS_MEDIA) return 1.0f;
  return refraction_index(media, after) / refraction_index(media, before);
}

HAVING(HAS_DISPERSION);

// The same at a wavelength: a (fractional) row of the table `spectra`.
static inline float index_at(UNIFORM const Scene* scene, int medium, float row) {
  float index = 1.0f;
  EACH_ALIKE(int, at, medium) {
    const u32 first = scene->media[at].spectrum;
    if (first == NO_SPECTRUM)
      index = scene->media[at].absorption.w;
    else
      index = spectrum_at(scene, first, row);
  }
  return index;
}
static inline float relative_index_at(UNIFORM const Scene* scene, int before, int after, float row) {
  return index_at(scene, after, row) / index_at(scene, before, row);
}

// Whether the relative index depends on the wavelength.
static inline bool disperses(UNIFORM const Scene* scene, int before, int after) {
  bool found = false;
  if (before == after) return false;
  EACH_ALIKE(int, at, before) found = scene->media[at].spectrum != NO_SPECTRUM;
  EACH_ALIKE(int, at, after) found = found || scene->media[at].spectrum != NO_SPECTRUM;
  return found;
}
