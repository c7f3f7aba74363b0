// How paths begin, how their rays leave surfaces, and how wavelengths part there. Photons use the same
// functions.
#ifndef SUNDOG_LIB_LEAVE_SURFACES_CL
#define SUNDOG_LIB_LEAVE_SURFACES_CL
#include "lib/light/shadow_rays.cl"
#include "lib/pathtracer/path_state.cl"
#include "lib/shade/bsdf_sample.cl"

static inline PathStates start_paths(const Scene* scene, const LaneSamples* at, MASK lanes) {
  PathStates paths;
  paths.throughput = spectrum_all(1.0f);
  paths.radiance = spectrum_all(0.0f);
  paths.from = all3((float3)(0.0f));
  paths.pdf = (REAL)(0.0f);
  paths.spread = (REAL)(1.0f);
  paths.depth = (MASK)(1);
  paths.covered = ALL_LANES;
  paths.straight = ALL_LANES;
  paths.at = *at;
  paths.wavelengths = choose_wavelengths(scene, at, lanes);
  forget_stretches(&paths);
  forget_gathered(&paths, ALL_LANES);
  return paths;
}

// The lanes of `lanes` become those of `other`.
static inline void join_paths(PathStates* paths, const PathStates* other, MASK lanes) {
  paths->throughput = spectrum_select(paths->throughput, other->throughput, lanes);
  paths->radiance = spectrum_select(paths->radiance, other->radiance, lanes);
  paths->from = select3(paths->from, other->from, lanes);
  paths->pdf = select(paths->pdf, other->pdf, lanes);
  paths->spread = select(paths->spread, other->spread, lanes);
  paths->depth = select(paths->depth, other->depth, lanes);
  paths->covered = select(paths->covered, other->covered, lanes);
  paths->straight |= other->straight & lanes;
  paths->at.x = select(paths->at.x, other->at.x, lanes);
  paths->at.y = select(paths->at.y, other->at.y, lanes);
  paths->at.sample = select(paths->at.sample, other->at.sample, lanes);
  join_wavelengths(&paths->wavelengths, &other->wavelengths, lanes);
  join_scattered(paths, other, lanes);
  join_gathered(paths, other, lanes);
}

#include "plain/pathtracer/leave_surface.cl"

// The hero wavelength decides where surfaces send light. SampledWavelengths part where a dispersing interface
// transmits or scatters light. Where it mirrors light all of them remain, each with its own reflectance.
#if HAS_DISPERSION
static inline void follow_hero(const SampledWavelengths* w, Bsdfs* bsdf) {
  set_wavelength_row(bsdf, wavelength_row(w->hero, 0));
}

static inline MASK parting_surfaces(const Scene* scene, const Shading* at, const SpecularSplits* split,
                                    MASK lanes) {
  const MASK bends = lanes & split->transmits & MASK_OF((at->bsdf.flags & (int)MATERIAL_THIN) == 0);
  return disperses(scene, at->bsdf.before, at->bsdf.after, bends);
}

NEVER_INLINE void part_wavelengths(const Scene* scene, const Shading* at, const SpecularSplits* split,
                                   PathStates* paths, MASK lanes, MASK mirror) {
  SampledWavelengths* w = &paths->wavelengths;
  const Bsdfs* bsdf = &at->bsdf;
  const MASK parting = parting_surfaces(scene, at, split, lanes);
  if (!any_lane(parting)) return;
  const MASK mirrored = parting & mirror & ~w->alone & MASK_OF(split->f > 0.0f);
  terminate_secondary(w, &paths->throughput, parting & ~mirrored);
  if (!any_lane(mirrored)) return;
  for (u32 i = 1; i < WAVELENGTHS; ++i) {
    const REAL eta =
        relative_index_at(scene, bsdf->before, bsdf->after, wavelength_row(w->hero, i), mirrored);
    const REAL f = fresnel_reflectance(split->cos_i, refracted_cosine(split->cos_i, eta), eta);
    paths->throughput.of[i] =
        select(paths->throughput.of[i], paths->throughput.of[i] * f / split->f, mirrored);
  }
}

// Light that such surfaces of `lanes` have from a lamp: the hero's alone.
static inline void keep_hero(const Scene* scene, const Shading* at, const SpecularSplits* split,
                             const PathStates* paths, SampledSpectrum* light, MASK lanes) {
  SampledWavelengths parted = paths->wavelengths;
  terminate_secondary(&parted, light, parting_surfaces(scene, at, split, lanes));
}
#else
static inline void follow_hero(const SampledWavelengths* w, Bsdfs* bsdf) {}
static inline void keep_hero(const Scene* scene, const Shading* at, const SpecularSplits* split,
                             const PathStates* paths, SampledSpectrum* light, MASK lanes) {}
static inline void part_wavelengths(const Scene* scene, const Shading* at, const SpecularSplits* split,
                                    PathStates* paths, MASK lanes, MASK mirror) {}
#endif

#endif
