// Media that scatter, on the way of paths to their next interfaces: each stretch of a ray gets light from one
// lamp, at a place that is chosen for it, and may end the ray at another, from where the path continues. A
// path a lane.
#ifndef SUNDOG_LIB_SCATTER_MEDIA_CL
#define SUNDOG_LIB_SCATTER_MEDIA_CL
#include "lib/path/ray_counts.cl"
#include "lib/pathtracer/next_event.cl"
#include "lib/pathtracer/path_state.cl"
#include "plain/pathtracer/roulette.cl"

#if HAS_SCATTERING
// What rays are before they go to their next interfaces.
typedef struct BegunRays {
  REAL t_min, since;
  MASK media_low, media_high, crossings;
} BegunRays;

static inline BegunRays begun_rays_of(const SceneRays* rays) {
  const BegunRays begun = {rays->t_min, rays->since, rays->media_low, rays->media_high, rays->crossings};
  return begun;
}

// Stretches of rays in media that scatter.
typedef struct Stretches {
  MASK lanes;
  REAL3 o, d;                  // where they begin
  REAL length;                 // to the next interface
  REAL begin;                  // length in the medium before them, for absorption
  SampledSpectrum decay;       // light lost per unit of length
  SampledSpectrum scattering;  // light scattered
  REAL g;                      // mean cosine of turns
  REAL mean;                   // of the decay's colours
  SampledSpectrum shares;      // of the colours, in the choice of the place where the path is scattered
  SampledSpectrum drawn;       // and of the one that gets light
} Stretches;

static inline Stretches find_stretches(const Scene* scene, const BegunRays* begun, const SceneRays* rays,
                                       const Encounters* met, const PathStates* paths, MASK lanes) {
  const REAL zero = (REAL)(0.0f);
  Stretches s;
  s.lanes = NO_LANES;
  s.o = along3(rays->o, begun->t_min, rays->d);
  s.d = rays->d;
  s.length = real_max(met->hit.t - begun->t_min, zero);
  s.begin = begun->t_min - begun->since;
  REAL3 decay = all3((float3)(0.0f)), scattering = decay;
  s.g = zero;
  u32 index;
  for (u32 left = lane_bits(lanes); left;) {
    const MASK mine = take_alike(met->before, &left, &index);
    const float4 some = scene->media[index].scattering;
    if (some.x + some.y + some.z <= 0.0f) continue;
    s.lanes |= mine;
    decay = select3(decay, all3(scene->media[index].absorption.xyz), mine);
    scattering = select3(scattering, all3(some.xyz), mine);
    s.g = select(s.g, (REAL)(some.w), mine);
  }
  s.mean = (decay.x + decay.y + decay.z) * (1.0f / 3.0f);
  s.decay = spectrum_of(&paths->wavelengths, decay);
  s.scattering = spectrum_of(&paths->wavelengths, scattering);
  s.shares = shares_of(paths->throughput);
  s.drawn = shares_of(where_positive(paths->throughput, s.scattering));
  return s;
}

// What arrives at the distance `at` of light that comes from the stretches' ends, and is scattered there.
static inline SampledSpectrum scattered_at(const PathStates* paths, const Stretches* s, REAL at) {
  const SampledSpectrum kept = spectrum_over(s->decay, s->begin + at);
  return spectrum_multiply(spectrum_multiply(paths->throughput, kept), s->scattering);
}

// The density of the distance `at` as the place where a path is scattered, and the chance that none is.
static inline REAL free_pdf(const Stretches* s, REAL at) {
  return spectrum_sum(spectrum_multiply(spectrum_multiply(s->shares, s->decay), spectrum_over(s->decay, at)));
}
static inline REAL chance_to_pass(const Stretches* s) {
  return spectrum_sum(spectrum_multiply(s->shares, spectrum_over(s->decay, s->length)));
}

// Rays of `lanes` that begin at the distance `at` of the stretches.
static inline SceneRays rays_from_stretch(const Scene* scene, const BegunRays* begun, const SceneRays* rays,
                                          const Stretches* s, REAL at, REAL3 d, REAL t_max, MASK lanes) {
  SceneRays made = *rays;
  const Hits nothing = no_hits(begun->t_min + at);
  start_on_surfaces(scene->info, &made, &nothing, NO_LANES, lanes);
  made.o = along3(s->o, at, s->d);
  made.d = d;
  made.t_min = (REAL)(0.0f);
  made.t_max = t_max;
  made.media_low = begun->media_low;
  made.media_high = begun->media_high;
  return made;
}

// A distance on each stretch that suits its light, with its density.
static inline REAL distance_for_light(const Scene* scene, const Stretches* s, MASK chosen, REAL u_way, REAL u,
                                      REAL u_color, MASK lanes, REAL* pdf) {
  REAL at = next_distance(s->decay, s->drawn, s->length, u, u_color);
  *pdf = next_pdf(s->decay, s->drawn, s->length, at);
  u32 index;
  for (u32 left = lane_bits(lanes); left;) {
    const MASK mine = take_alike(chosen, &left, &index);
    __global const Light* lamp = scene->lights + index;
    if (!has_place(lamp)) continue;
    const SeenStretch seen = see_stretch(s->o, s->d, s->length, s->mean, middle_of_light(lamp));
    at = select(at, distance_by_angle(&seen, s->length, u), mine & MASK_OF(u_way < seen.part));
    const REAL chance = next_pdf(s->decay, s->drawn, s->length, at);
    *pdf = select(*pdf, pdf_towards(&seen, at, chance), mine);
  }
  return at;
}

// Light of one lamp that the stretches of `lanes` scatter towards their beginnings.
NEVER_INLINE SampledSpectrum light_on_stretch(const Scene* scene, const PathStates* paths,
                                              const BegunRays* begun, const SceneRays* rays,
                                              const Stretches* s, MASK dimension, MASK lanes, u32* counts) {
  const REAL zero = (REAL)(0.0f);
  const FourNumbers u = sample_lanes(&paths->at, dimension), v = sample_lanes(&paths->at, dimension + 4);
  const REAL3 place = place_for_lights(s->o, s->d, s->length, s->mean);
  REAL chance, pdf;
  const MASK chosen = choose_index(scene, place, u.z, lanes, &chance);
  const REAL at = distance_for_light(scene, s, chosen, u.w, v.z, v.w, lanes, &pdf);
  MASK seen;
  const LightSamples light = sample_chosen(scene, along3(s->o, at, s->d), u.x, u.y, chosen, lanes, &seen);
  const REAL turned = phase_pdf(s->g, dot3(s->d, light.wi));
  pdf *= light.pdf * chance;
  const REAL weight = weight_of_chosen(scene, pdf, select(zero, free_pdf(s, at) * turned, seen), lanes);
  const REAL over = select((REAL)(1.0f), (REAL)(M_PI_F), light.delta) * turned * weight / pdf;
  SampledSpectrum possible =
      spectrum_multiply(scattered_at(paths, s, at), spectrum_of(&paths->wavelengths, light.radiance));
  possible = spectrum_scale(possible, over);
  const MASK lit = lanes & MASK_OF(spectrum_greatest(possible) >= FLT_MIN) & MASK_OF(light.distance > 0.0f);
  if (!any_lane(lit)) return spectrum_all(0.0f);
  counts[COUNT_SHADOW] += lane_count(lit);
  note_own_rays(lit, counts);
  SceneRays to_light = rays_from_stretch(scene, begun, rays, s, at, light.wi, light.distance, lit);
  return spectrum_select(spectrum_all(0.0f),
                         arriving_spectrum(scene, &paths->wavelengths, &to_light, possible, lit, counts),
                         lit);
}

// The paths of `lanes` are scattered at the distances `at` of their stretches. Returns those that continue.
static inline MASK turn_on_stretch(const Scene* scene, PathStates* paths, const BegunRays* begun,
                                   SceneRays* rays, const Stretches* s, REAL at, MASK lanes, u32* counts) {
  const MASK dimension = dimension_here(paths, BOUNCE_DIRECTION);
  const FourNumbers u = wanted_lanes(&paths->at, dimension, true, false);
  const REAL pdf = free_pdf(s, at), cosine = phase_cosine(s->g, u.x);
  const SampledSpectrum left =
      spectrum_scale(scattered_at(paths, s, at), 1.0f / real_max(pdf, (REAL)(1e-30f)));
  paths->throughput = spectrum_select(paths->throughput, left, lanes);
  const Scattered scattered = {
      lanes, s->o, s->d, s->length, at, s->mean, next_pdf(s->decay, s->drawn, s->length, at)};
  join_stretch(paths, &scattered, lanes);
  forget_gathered(paths, lanes);
  paths->pdf = select(paths->pdf, pdf * phase_pdf(s->g, cosine), lanes);
  paths->from = select3(paths->from, along3(s->o, at, s->d), lanes);
  paths->straight &= ~lanes;
  MASK going = lanes & MASK_OF(spectrum_greatest(paths->throughput) > 0.0f);
  const MASK allowed = going & MASK_OF(paths->depth <= (int)scene->info->max_depth);
  counts[COUNT_DEPTH_LIMIT] += lane_count(going & ~allowed);
  going = allowed & survives(scene, paths, dimension, allowed);
  paths->depth -= lanes;
  counts[COUNT_REFLECTION] += lane_count(going);
  note_own_rays(going, counts);
  SceneRays child = rays_from_stretch(scene, begun, rays, s, at, direction_about(s->d, cosine, u.y),
                                      (REAL)(INFINITY), lanes);
  join_rays(rays, &child, lanes);
  return going;
}

// The paths of `lanes` on their ways to what they have met. Returns those that do not get there, with those
// of them that continue.
NEVER_INLINE MASK scatter_in_media(const Scene* scene, PathStates* paths, const BegunRays* begun,
                                   SceneRays* rays, const Encounters* met, MASK lanes, MASK* going,
                                   u32* counts) {
  const Stretches s = find_stretches(scene, begun, rays, met, paths, lanes);
  *going = NO_LANES;
  if (!any_lane(s.lanes)) return NO_LANES;
  const MASK dimension = (MASK)((int)DIMENSION_STRETCH) + (paths->depth - 1) * (int)DIMENSIONS_A_BOUNCE +
                         begun->crossings * (int)DIMENSIONS_A_CROSSING;
  const MASK lit = s.lanes & MASK_OF(paths->depth <= (int)scene->info->max_depth);
  if (scene->info->light_count && any_lane(lit)) {
    const SampledSpectrum light = light_on_stretch(scene, paths, begun, rays, &s, dimension, lit, counts);
    paths->radiance = spectrum_select(paths->radiance, spectrum_add(paths->radiance, light), lit);
  }
  const FourNumbers v = sample_lanes(&paths->at, dimension + 4);
  const REAL chosen = by_share(s.decay, s.shares, v.y);
  const REAL at = select((REAL)(INFINITY), depth_of_lost(v.x) / nonzero(chosen), MASK_OF(chosen > 0.0f));
  const MASK turning = s.lanes & MASK_OF(at < s.length), passing = s.lanes & ~turning;
  const REAL passed = real_max(chance_to_pass(&s), (REAL)(1e-30f));
  paths->throughput =
      spectrum_select(paths->throughput, spectrum_scale(paths->throughput, 1.0f / passed), passing);
  if (any_lane(turning)) *going = turn_on_stretch(scene, paths, begun, rays, &s, at, turning, counts);
  return turning;
}

#else
typedef struct BegunRays {
  MASK unused;
} BegunRays;
static inline BegunRays begun_rays_of(const SceneRays* rays) {
  const BegunRays none = {NO_LANES};
  return none;
}
static inline MASK scatter_in_media(const Scene* scene, PathStates* paths, const BegunRays* begun,
                                    SceneRays* rays, const Encounters* met, MASK lanes, MASK* going,
                                    u32* counts) {
  *going = NO_LANES;
  return NO_LANES;
}
#endif

#endif
