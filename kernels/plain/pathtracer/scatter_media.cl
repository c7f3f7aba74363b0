// Media that scatter, on the way of a path to its next interface: each segment of a ray gets light from one
// lamp, at a place that is chosen for it, and may end the ray at another, from where the path continues.
#include "plain/pathtracer/gather_beams.cl"
#include "plain/pathtracer/next_event.cl"
#include "plain/pathtracer/roulette.cl"

// Light from the segment's end that is scattered at the distance `at`.
static inline SampledSpectrum scattered_at(const PathState* path, const MediumSegment* s, float at) {
  return path->throughput * spectrum_over(s->decay, s->begin + at) * s->scattering;
}

// The density of the distance `at` as the place where a path is scattered, and the chance that none is.
static inline float free_pdf(const MediumSegment* s, float at) {
  return spectrum_sum(s->shares * s->decay * spectrum_over(s->decay, at));
}
static inline float chance_to_pass(const MediumSegment* s) {
  return spectrum_sum(s->shares * spectrum_over(s->decay, s->length));
}

// A ray that begins at the distance `at` of the segment.
HAVING(HAS_SCATTERING)
static inline SceneRay ray_from_segment(UNIFORM const Scene* scene, const BegunRay* begun,
                                        const SceneRay* ray, const MediumSegment* s, float at, float3 d,
                                        float t_max) {
  SceneRay made = *ray;
  const SurfaceHit nothing = hit_nothing(begun->t_min + at);
  start_on_surfaces(scene->info, &made, &nothing, false);
  made.o = along(s->o, at, s->d);
  made.d = d;
  made.t_min = 0.0f;
  made.t_max = t_max;
  made.media = begun->media;
  if (HAS_SIDES) made.sides = begun->sides;
  return made;
}

// A distance on the segment that suits its light, with its density.
static inline float distance_for_light(UNIFORM const Scene* scene, const MediumSegment* s, int chosen,
                                       float u_way, float u, float u_color, float* pdf) {
  float at = next_distance(s->decay, s->drawn, s->length, u, u_color);
  float chance = next_pdf(s->decay, s->drawn, s->length, at);
  EACH_ALIKE(int, index, chosen) {
    __global const Light* lamp = scene->lights + index;
    if (has_place(lamp)) {
      const SeenSegment seen = see_segment(s->o, s->d, s->length, s->mean, middle_of_light(lamp));
      if (u_way < seen.part) at = distance_by_angle(&seen, s->length, u);
      chance = pdf_towards(&seen, at, next_pdf(s->decay, s->drawn, s->length, at));
    }
  }
  *pdf = chance;
  return at;
}

// Light of one lamp that the segment scatters towards its beginning.
HAVING(HAS_SCATTERING)
static SampledSpectrum light_on_segment(UNIFORM const Scene* scene, PathState* path, const BegunRay* begun,
                                        const SceneRay* ray, const MediumSegment* s, int dimension,
                                        UNIFORM u32* counts) {
  const Numbers u = numbers_at(&path->at, dimension, true, true),
                v = numbers_at(&path->at, dimension + 4, true, true);
  float chance, pdf;
  bool seen;
  const float3 place = place_for_lights(s->o, s->d, s->length, s->mean);
  const int chosen = choose_index(scene, place, u.z, &chance);
  const float at = distance_for_light(scene, s, chosen, u.w, v.z, v.w, &pdf);
  const LightSample light = sample_chosen(scene, along(s->o, at, s->d), u.x, u.y, chosen, &seen);
  const float turned = phase_pdf(s->g, dot(s->d, light.wi));
  pdf *= light.pdf * chance;
  const float weight = weight_of_chosen(scene, pdf, seen ? free_pdf(s, at) * turned : 0.0f);
  const float over = (light.delta ? M_PI_F : 1.0f) * turned * weight / pdf;
  const SampledSpectrum possible =
      scattered_at(path, s, at) * spectrum_of(&path->wavelengths, light.radiance) * over;
  if (!(spectrum_greatest(possible) >= FLT_MIN && light.distance > 0.0f)) return (SampledSpectrum)(0.0f);
  count(counts, COUNT_SHADOW);
  note_ray(counts);
  SceneRay to_light = ray_from_segment(scene, begun, ray, s, at, light.wi, light.distance);
  const SampledSpectrum arriving = arriving_spectrum(scene, &path->wavelengths, &to_light, possible, counts);
  if (HAS_LIGHT_GROUPS) note_group(path, group_of(scene, chosen), arriving);
  if (HAS_LIGHT_PARTS) {
    const LobeShares shares = all_of_medium();
    note_sent(path, &shares, true, arriving);
  }
  return arriving;
}

// The path is scattered at the distance `at` of its segment. Returns whether it continues.
HAVING(HAS_SCATTERING)
static inline bool turn_on_segment(UNIFORM const Scene* scene, PathState* path, const BegunRay* begun,
                                   SceneRay* ray, const Encounter* met, const MediumSegment* s, float at,
                                   UNIFORM u32* counts) {
  const int dimension = dimension_here(path->depth, BOUNCE_DIRECTION);
  const Numbers u = numbers_at(&path->at, dimension, true, true);
  const float pdf = free_pdf(s, at), cosine = phase_cosine(s->g, u.x);
  path->throughput = scattered_at(path, s, at) * (1.0f / real_max(pdf, 1e-30f));
  const Scattered here = {
      true, s->o, s->d, s->length, at, s->mean, next_pdf(s->decay, s->drawn, s->length, at)};
  path->scattered = here;
  if (HAS_CAUSTICS) note_gathered(path, false, (float3)(0.0f));
  path->pdf = pdf * phase_pdf(s->g, cosine);
  path->from = along(s->o, at, s->d);
  if (HAS_FOG) path->unfog = 1.0f;
  path->straight = false;
  if (HAS_MATTES) note_medium(path, met);
  if (HAS_LIGHT_PARTS) {
    const LobeShares shares = all_of_medium();
    note_scattering(path, &shares);
  }
  bool going = spectrum_greatest(path->throughput) > 0.0f;
  if (going && limited_depth(path) > (int)scene->info->max_depth) {
    count(counts, COUNT_DEPTH_LIMIT);
    going = false;
  }
  if (going) going = survives(scene, path, u.w);
  ++path->depth;
  if (going) {
    count(counts, COUNT_REFLECTION);
    note_ray(counts);
  }
  *ray = ray_from_segment(scene, begun, ray, s, at, direction_about(s->d, cosine, u.y), INFINITY);
  return going;
}

HAVING(HAS_SCATTERING)
static bool scatter_on_segment(UNIFORM const Scene* scene, PathState* path, const BegunRay* begun,
                               SceneRay* ray, const Encounter* met, bool* going, UNIFORM u32* counts) {
  const MediumSegment s = find_medium_segment(scene, begun, ray, met, &path->wavelengths, path->throughput);
  *going = false;
  if (!any(s.scatters)) return false;
  const int dimension = (int)DIMENSION_STRETCH + (path->depth - 1) * (int)DIMENSIONS_A_BOUNCE +
                        begun->crossings * (int)DIMENSIONS_A_CROSSING;
  if (s.scatters && limited_depth(path) <= (int)scene->info->max_depth) {
    if (scene->info->light_count > 0u)
      path->radiance += light_on_segment(scene, path, begun, ray, &s, dimension, counts);
    if (HAS_CAUSTICS) path->radiance += gather_beams(scene, path, ray, &s);
  }
  const Numbers v = numbers_at(&path->at, dimension + 4, true, true);
  const float chosen = by_share(s.decay, s.shares, v.y);
  const float at = chosen > 0.0f ? depth_of_lost(v.x) / nonzero(chosen) : INFINITY;
  const bool turns = s.scatters && at < s.length;
  if (s.scatters && !turns) path->throughput *= 1.0f / real_max(chance_to_pass(&s), 1e-30f);
  if (turns) *going = turn_on_segment(scene, path, begun, ray, met, &s, at, counts);
  return turns;
}

// The path on its way to what it has met. Returns whether it does not get there, and in `going` whether it
// continues then.
static inline bool scatter_in_media(UNIFORM const Scene* scene, PathState* path, const BegunRay* begun,
                                    SceneRay* ray, const Encounter* met, bool* going, UNIFORM u32* counts) {
  if (HAS_SCATTERING) return scatter_on_segment(scene, path, begun, ray, met, going, counts);
  return false;
}
