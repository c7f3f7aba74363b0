// How paths begin, how their rays leave surfaces, and how wavelengths part there. Photons use the same
// functions.
#ifndef SUNDOG_LIB_LEAVE_SURFACES_CL
#define SUNDOG_LIB_LEAVE_SURFACES_CL
#include "lib/light/shadow_rays.cl"
#include "lib/pathtracer/walk_state.cl"
#include "lib/shade/bsdf_sample.cl"

static inline Walks start_walks(const Scene* scene, const LaneSamples* at, MASK lanes) {
  Walks walks;
  walks.throughput = carry_all(1.0f);
  walks.light = carry_all(0.0f);
  walks.from = all3((float3)(0.0f));
  walks.density = (REAL)(0.0f);
  walks.spread = (REAL)(1.0f);
  walks.depth = (MASK)(1);
  walks.met = NO_LANES;
  walks.straight = ALL_LANES;
  walks.at = *at;
  walks.wavelengths = choose_wavelengths(scene, at, lanes);
  forget_stretches(&walks);
  forget_gathered(&walks, ALL_LANES);
  return walks;
}

// The lanes of `lanes` become those of `other`.
static inline void join_walks(Walks* walks, const Walks* other, MASK lanes) {
  walks->throughput = carry_select(walks->throughput, other->throughput, lanes);
  walks->light = carry_select(walks->light, other->light, lanes);
  walks->from = select3(walks->from, other->from, lanes);
  walks->density = select(walks->density, other->density, lanes);
  walks->spread = select(walks->spread, other->spread, lanes);
  walks->depth = select(walks->depth, other->depth, lanes);
  walks->met = select(walks->met, other->met, lanes);
  walks->straight |= other->straight & lanes;
  walks->at.x = select(walks->at.x, other->at.x, lanes);
  walks->at.y = select(walks->at.y, other->at.y, lanes);
  walks->at.sample = select(walks->at.sample, other->at.sample, lanes);
  join_wavelengths(&walks->wavelengths, &other->wavelengths, lanes);
  join_scattered(walks, other, lanes);
  join_gathered(walks, other, lanes);
}

// The rays of `lanes` in the directions that their surfaces sampled. Those of `free` are not there.
static inline void leave_surfaces(const Scene* scene, const Encounters* met, const Shading* at,
                                  const BsdfSamples* sample, MASK below, MASK free, MASK lanes,
                                  SceneRays* rays) {
  const SurfaceInteractions* s = &at->s;
  SceneRays child = *rays;
  start_on_surfaces(scene->info, &child, &met->hit, ~s->entering, lanes);
  child.t_min = (REAL)(0.0f);
  child.t_max = (REAL)(INFINITY);
  child.d = sample->wi;
  REAL way;
  const REAL3 outside = along3(leave_relief(s, child.d, &way), s->offset, leaving_normal(s));
  child.o = select3(outside, points_behind(scene, s, rays->d, below), below);
  if (any_lane(below)) {
    start_on_hits(scene->info, &child, &met->hit, s->entering, below);
    enter_behind(met, rays, below, &child);
  }
  cross_further(rays, free, &child);
  join_rays(rays, &child, lanes);
}

// The hero wavelength decides where surfaces send light. Wavelengths part where a dispersing interface
// transmits or scatters light. Where it mirrors light all of them remain, each with its own reflectance.
#if HAS_DISPERSION
static inline void follow_hero(const Wavelengths* w, Bsdfs* bsdf) {
  set_wavelength_row(bsdf, wavelength_row(w->hero, 0));
}

static inline MASK parting_surfaces(const Scene* scene, const Shading* at, const SpecularSplits* split,
                                    MASK lanes) {
  const MASK bends = lanes & split->transmits & MASK_OF((at->bsdf.flags & (int)MATERIAL_THIN) == 0);
  return disperses(scene, at->bsdf.before, at->bsdf.after, bends);
}

NEVER_INLINE void part_wavelengths(const Scene* scene, const Shading* at, const SpecularSplits* split,
                                   Walks* walks, MASK lanes, MASK mirror) {
  Wavelengths* w = &walks->wavelengths;
  const Bsdfs* bsdf = &at->bsdf;
  const MASK parting = parting_surfaces(scene, at, split, lanes);
  if (!any_lane(parting)) return;
  const MASK mirrored = parting & mirror & ~w->alone & MASK_OF(split->f > 0.0f);
  leave_hero(w, &walks->throughput, parting & ~mirrored);
  if (!any_lane(mirrored)) return;
  for (u32 i = 1; i < WAVELENGTHS; ++i) {
    const REAL eta =
        relative_index_at(scene, bsdf->before, bsdf->after, wavelength_row(w->hero, i), mirrored);
    const REAL f = fresnel_reflectance(split->cos_i, refracted_cosine(split->cos_i, eta), eta);
    walks->throughput.of[i] =
        select(walks->throughput.of[i], walks->throughput.of[i] * f / split->f, mirrored);
  }
}

// Light that such surfaces of `lanes` have from a lamp: the hero's alone.
static inline void keep_hero(const Scene* scene, const Shading* at, const SpecularSplits* split,
                             const Walks* walks, Carried* light, MASK lanes) {
  Wavelengths parted = walks->wavelengths;
  leave_hero(&parted, light, parting_surfaces(scene, at, split, lanes));
}
#else
static inline void follow_hero(const Wavelengths* w, Bsdfs* bsdf) {}
static inline void keep_hero(const Scene* scene, const Shading* at, const SpecularSplits* split,
                             const Walks* walks, Carried* light, MASK lanes) {}
static inline void part_wavelengths(const Scene* scene, const Shading* at, const SpecularSplits* split,
                                    Walks* walks, MASK lanes, MASK mirror) {}
#endif

#endif
