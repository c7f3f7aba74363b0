// The hero wavelength decides where surfaces send light. Wavelengths part where a dispersing interface
// transmits or scatters light. Where it mirrors light all of them remain, each with its own reflectance.
#include "plain/pathtracer/path_state.cl"

static inline void follow_hero(const SampledWavelengths* w, Bsdf* bsdf) {
  if (HAS_DISPERSION) bsdf->row = wavelength_row(w->hero, 0u);
}

HAVING(HAS_DISPERSION)
static inline bool parts_wavelengths(UNIFORM const Scene* scene, const SurfaceShading* at,
                                     const Interface* interface) {
  return interface->transmits && (at->bsdf.flags & (int)MATERIAL_THIN) == 0 &&
         disperses(scene, at->bsdf.before, at->bsdf.after);
}

// The reflectance of wavelength i over the hero's.
HAVING(HAS_DISPERSION)
static inline float reflectance_of(UNIFORM const Scene* scene, const SurfaceShading* at,
                                   const Interface* interface, float hero, UNIFORM u32 i) {
  const float eta = relative_index_at(scene, at->bsdf.before, at->bsdf.after, wavelength_row(hero, i));
  return fresnel_reflectance(interface->cos_i, refracted_cosine(interface->cos_i, eta), eta);
}

HAVING(HAS_DISPERSION)
static void part_wavelengths(UNIFORM const Scene* scene, const SurfaceShading* at, const Interface* interface,
                             bool mirror, SampledWavelengths* w, SampledSpectrum* carried) {
  if (!parts_wavelengths(scene, at, interface)) return;
  if (!mirror || w->alone || !(interface->f > 0.0f)) {
    terminate_secondary(w, carried);
  } else {
    (*carried).y = (*carried).y * reflectance_of(scene, at, interface, w->hero, 1u) / interface->f;
    (*carried).z = (*carried).z * reflectance_of(scene, at, interface, w->hero, 2u) / interface->f;
    (*carried).w = (*carried).w * reflectance_of(scene, at, interface, w->hero, 3u) / interface->f;
  }
}

// Light that such a surface has from a lamp: the hero's alone.
static inline SampledSpectrum kept_hero(UNIFORM const Scene* scene, const SurfaceShading* at,
                                        const Interface* interface, bool alone, SampledSpectrum light) {
  SampledSpectrum kept = light;
  if (HAS_DISPERSION && parts_wavelengths(scene, at, interface)) {
    SampledWavelengths parted;
    parted.alone = alone;
    terminate_secondary(&parted, &kept);
  }
  return kept;
}
