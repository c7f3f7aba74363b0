// Light chosen at the surfaces of paths: one light each, a place on it, and a shadow ray there.
#ifndef SUNDOG_LIB_NEXT_EVENT_CL
#define SUNDOG_LIB_NEXT_EVENT_CL
#include "lib/light/shadow.cl"
#include "lib/light/shadow_rays.cl"
#include "lib/path/ray_counts.cl"
#include "lib/pathtracer/guides.cl"
#include "lib/pathtracer/walk_state.cl"
#include "lib/shade/bsdf_sample.cl"

// The lanes of `lanes` that drew the tree's lights choose one of them, by the number u in [0, 1); its
// probability goes into the chance that they chose it with.
#if HAS_LIGHT_TREE
static inline void choose_in_tree(const Scene* scene, REAL3 p, REAL u, MASK lanes, MASK* chosen,
                                  REAL* chance) {
  const MASK among = lanes & MASK_OF(*chosen == (int)LIGHT_CHOSEN);
  if (!any_lane(among)) return;
  REAL probability;
  const MASK leaf = choose_lights(scene, p, u, among, &probability);
  *chosen = select(*chosen, leaf, among);
  *chance = select(*chance, *chance * probability, among);
}
#else
static inline void choose_in_tree(const Scene* scene, REAL3 p, REAL u, MASK lanes, MASK* chosen,
                                  REAL* chance) {}
#endif

// One of the lights for each of the points p, and the chance that it is chosen with.
static inline MASK choose_index(const Scene* scene, REAL3 p, REAL u, MASK lanes, REAL* chance) {
  const REAL count = (REAL)((float)scene->info->light_count), turn = u * count;
  const REAL slot = real_min(floor(turn), count - 1.0f);
  const MASK slots = TO_MASK(slot);
  MASK chosen = NO_LANES;
  *chance = 1.0f / count;
  u32 index;
  for (u32 left = lane_bits(lanes); left;) {
    const MASK mine = take_alike(slots, &left, &index);
    chosen = select(chosen, (MASK)((int)scene->light_rays[index].light), mine);
  }
  choose_in_tree(scene, p, turn - slot, lanes, &chosen, chance);
  return chosen;
}

// A way from the points p to their lights; `seen`: rays may meet it.
static inline LightSamples sample_chosen(const Scene* scene, REAL3 p, REAL u_x, REAL u_y, MASK chosen,
                                         MASK lanes, MASK* seen) {
  LightSamples light;
  u32 index;
  light.wi = all3((float3)(0.0f));
  light.distance = (REAL)(0.0f);
  light.radiance = all3((float3)(0.0f));
  light.density = (REAL)(1.0f);
  light.delta = NO_LANES;
  *seen = NO_LANES;
  for (u32 left = lane_bits(lanes); left;) {
    const MASK mine = take_alike(chosen, &left, &index);
    const LightSamples one = sample_light(scene, index, p, u_x, u_y, mine);
    light.wi = select3(light.wi, one.wi, mine);
    light.distance = select(light.distance, one.distance, mine);
    light.radiance = select3(light.radiance, one.radiance, mine);
    light.density = select(light.density, one.density, mine);
    light.delta = select(light.delta, one.delta, mine);
    if (rays_meet(scene, index)) *seen |= mine;
  }
  return light;
}

// A way to one of the lights for each of the points p, with its density among all.
static inline LightSamples choose_one(const Scene* scene, REAL3 p, const FourNumbers* u, MASK lanes,
                                      MASK* seen) {
  REAL chance;
  const MASK chosen = choose_index(scene, p, u->z, lanes, &chance);
  LightSamples light = sample_chosen(scene, p, u->x, u->y, chosen, lanes, seen);
  // Of a delta light the chance counts for the light, not for a direction.
  light.density *= chance;
  return light;
}

// Shadow rays of `lanes` from the surfaces to the lights. `below`: they leave behind the surface.
static inline SceneRays rays_to_light(const Scene* scene, const SceneRays* rays, const Encounters* met,
                                      const Shading* at, const LightSamples* light, MASK below, MASK lanes) {
  const SurfaceInteractions* s = &at->s;
  SceneRays to_light = *rays;
  start_on_surfaces(scene->info, &to_light, &met->hit, ~s->entering, lanes);
  REAL way;
  const REAL3 outside = along3(leave_relief(s, light->wi, &way), s->offset, leaving_normal(s));
  to_light.o = select3(outside, points_behind(scene, s, rays->d, below), below);
  if (any_lane(below)) {
    start_on_hits(scene->info, &to_light, &met->hit, s->entering, below);
    enter_behind(met, rays, below, &to_light);
  }
  to_light.d = light->wi;
  to_light.t_min = (REAL)(0.0f);
  to_light.t_max = select(light->distance - way, light->distance, below);
  return to_light;
}

// The part of `light` that arrives at the ends of shadow rays.
#if HAS_DISPERSION
static inline Carried carried_to_light(const Scene* scene, const Wavelengths* w, SceneRays* rays,
                                       Carried light, MASK lanes, u32* counts) {
  const REAL3 kept = light_arriving(scene, rays, all3((float3)(1.0f)), lanes, counts);
  const MASK some = MASK_OF(greatest3(kept) > 0.0f);
  return carry_select(carry_all(0.0f), carry_multiply(light, carry_kept(w, kept)), some);
}
#else
static inline Carried carried_to_light(const Scene* scene, const Wavelengths* w, SceneRays* rays,
                                       Carried light, MASK lanes, u32* counts) {
  return light_arriving(scene, rays, light, lanes, counts);
}
#endif

// What lights send to the surfaces of `lanes`, times what those make of it.
NEVER_INLINE Carried next_event(const Scene* scene, const Walks* walks, const SceneRays* rays,
                                const Encounters* met, const Shading* at, const Lobes* lobes,
                                const FourNumbers* u, MASK lanes, u32* counts) {
  const REAL zero = (REAL)(0.0f), one = (REAL)(1.0f);
  const Carried none = carry_all(0.0f);
  const REAL3 wo = negate3(rays->d);
  const SurfaceInteractions* s = &at->s;
  MASK seen;
  const LightSamples light = choose_one(scene, s->p, u, lanes, &seen);
  REAL scattered;
  const REAL3 scattering = bsdf_scatter(scene, &at->bsdf, lobes, wo, light.wi, lanes, &scattered);
  scattered = guided_density(scene, lobes, s->p, light.wi, scattered, lanes);
  Carried possible = carry_color(&walks->wavelengths, scattering);
  const REAL weight = weight_of_chosen(scene, light.density, select(zero, scattered, seen));
  const REAL over = select(1.0f / (M_PI_F * light.density), one / light.density, light.delta);
  possible = carry_multiply(possible, carry_color(&walks->wavelengths, light.radiance));
  possible = carry_scale(possible, weight * over);
  const MASK below = lanes & MASK_OF(dot3(s->ng, light.wi) < 0.0f);
  if (HAS_RELIEF) possible = carry_scale(possible, select(terminator(s, light.wi), one, below));
  if (HAS_PARALLAX) {
    possible = carry_scale(possible, relief_visibility(scene, s, light.wi, lanes));
    possible = carry_scale(possible, walls_visibility(scene, rays, s, light.wi, lanes, counts));
  }
  if (HAS_MEDIA && any_lane(below)) {
    const REAL eta = lobes->split.eta;
    possible = carry_scale(possible, select(one, 1.0f / (eta * eta), below));
  }
  possible = carry_multiply(possible, walks->throughput);
  const MASK lit = lanes & MASK_OF(carry_greatest(possible) >= FLT_MIN) & MASK_OF(light.distance > 0.0f);
  if (!any_lane(lit)) return none;
  counts[COUNT_SHADOW] += lane_count(lit);
  note_own_rays(lit, counts);
  SceneRays to_light = rays_to_light(scene, rays, met, at, &light, below, lit);
  return carry_select(none, carried_to_light(scene, &walks->wavelengths, &to_light, possible, lit, counts),
                      lit);
}

#endif
