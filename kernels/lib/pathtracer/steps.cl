// One step of a batch of paths: each ray to the next interface, the light that it meets there, the light
// chosen there, and the ray that continues. Nothing waits: a path is its one ray and its Walks.
#ifndef SUNDOG_LIB_PATH_STEPS_CL
#define SUNDOG_LIB_PATH_STEPS_CL
#include "lib/pathtracer/met_light.cl"
#include "lib/pathtracer/next_event.cl"

// The spread of the cone of what a surface scatters, at least.
#define SCATTERED_SPREAD 0.2f

static inline Walks start_walks(const LaneSamples* at) {
  const REAL3 none = all3((float3)(0.0f));
  const REAL zero = (REAL)(0.0f), one = (REAL)(1.0f);
  const Walks walks = {all3((float3)(1.0f)), none, none, zero, one, (MASK)(1), NO_LANES, *at};
  return walks;
}

// The lanes of `lanes` become those of `other`.
static inline void join_walks(Walks* walks, const Walks* other, MASK lanes) {
  walks->throughput = select3(walks->throughput, other->throughput, lanes);
  walks->light = select3(walks->light, other->light, lanes);
  walks->from = select3(walks->from, other->from, lanes);
  walks->density = select(walks->density, other->density, lanes);
  walks->spread = select(walks->spread, other->spread, lanes);
  walks->depth = select(walks->depth, other->depth, lanes);
  walks->met = select(walks->met, other->met, lanes);
  walks->at.x = select(walks->at.x, other->at.x, lanes);
  walks->at.y = select(walks->at.y, other->at.y, lanes);
  walks->at.sample = select(walks->at.sample, other->at.sample, lanes);
}
static inline void join_rays(SceneRays* rays, const SceneRays* others, MASK lanes) {
  rays->o = select3(rays->o, others->o, lanes);
  rays->d = select3(rays->d, others->d, lanes);
  rays->t_min = select(rays->t_min, others->t_min, lanes);
  rays->t_max = select(rays->t_max, others->t_max, lanes);
  rays->media_low = select(rays->media_low, others->media_low, lanes);
  rays->media_high = select(rays->media_high, others->media_high, lanes);
#if HAS_MEDIA
  rays->since = select(rays->since, others->since, lanes);
#endif
#if RAYS_CROSS
  rays->crossings = select(rays->crossings, others->crossings, lanes);
#endif
#if HAS_SDF
  rays->from = select(rays->from, others->from, lanes);
  rays->footprint = select(rays->footprint, others->footprint, lanes);
#endif
#if HAS_CONES
  rays->cone_width = select(rays->cone_width, others->cone_width, lanes);
  rays->cone_spread = select(rays->cone_spread, others->cone_spread, lanes);
#endif
#if HAS_GLOW
  rays->glow = select3(rays->glow, others->glow, lanes);
#endif
}

// Paths of `lanes` that continue after Russian roulette: they stand for those that end.
// What refraction took from the radiance comes back when the ray leaves the medium, and says nothing of its
// worth.
static inline MASK play_roulette(const Scene* scene, Walks* walks, REAL u, MASK lanes) {
  const MASK playing = lanes & MASK_OF(walks->depth >= (int)scene->info->roulette_depth);
  const REAL worth = greatest3(walks->throughput) * walks->spread;
  const REAL chance = select((REAL)(1.0f), real_min(worth, (REAL)(0.95f)), playing);
  walks->throughput = scale3(walks->throughput, 1.0f / real_max(chance, (REAL)(1e-20f)));
  return lanes & MASK_OF(u < chance);
}

// The rays of `lanes` in the directions that their surfaces sampled.
static inline void leave_surfaces(const Scene* scene, const Encounters* met, const Shading* at,
                                  const BsdfSamples* sample, MASK below, MASK lanes, SceneRays* rays) {
  const SurfaceInteractions* s = &at->s;
  SceneRays child = *rays;
  start_on_surfaces(scene->info, &child, &met->hit, ~s->entering, lanes);
  child.t_min = (REAL)(0.0f);
  child.t_max = (REAL)(INFINITY);
  child.d = sample->wi;
  child.o = along3(s->p, select(s->offset, -s->offset, below), s->ng);
#if HAS_CONES
  child.cone_spread =
      select(real_max(child.cone_spread, (REAL)(SCATTERED_SPREAD)), child.cone_spread, sample->specular);
#endif
  if (any_lane(below)) {
    start_on_hits(scene->info, &child, &met->hit, s->entering, below);
    enter_behind(met, rays, below, &child);
  }
  join_rays(rays, &child, lanes);
}

// Surfaces of `lanes` scatter: the paths' next rays. Returns the paths that continue.
NEVER_INLINE MASK scatter(const Scene* scene, const Encounters* met, const Shading* at, const Lobes* lobes,
                          Walks* walks, SceneRays* rays, MASK lanes, u32* counts) {
  const REAL zero = (REAL)(0.0f), one = (REAL)(1.0f);
  const FourNumbers u = sample_lanes(
      &walks->at, (walks->depth - 1) * (int)DIMENSIONS_A_BOUNCE + (int)(DIMENSION_BOUNCE + BOUNCE_DIRECTION));
  const REAL3 wo = negate3(rays->d);
  const BsdfSamples sample = sample_lobes(scene, &at->bsdf, lobes, wo, u.z, u.x, u.y, lanes);
  const MASK some = lanes & MASK_OF(greatest3(sample.weight) > 0.0f);
  const MASK below = some & MASK_OF(dot3(at->s.ng, sample.wi) < 0.0f);
  walks->throughput = select3(walks->throughput, multiply3(walks->throughput, sample.weight), lanes);
  if (HAS_RELIEF)
    walks->throughput = scale3(walks->throughput,
                               select(one, terminator(&at->s, sample.wi), lanes & ~below & ~sample.specular));
  if (HAS_MEDIA) {
    const REAL eta = select(one, lobes->split.eta, below), square = eta * eta;
    walks->throughput = scale3(walks->throughput, 1.0f / square);
    walks->spread *= square;
  }
  // Shadow rays go through filters as the path does: what it was about to find, it still is.
  const MASK passes = below & sample.specular & MASK_OF((at->bsdf.flags & (int)MATERIAL_SHADOW_OPAQUE) == 0);
  const MASK turns = lanes & ~passes;
  walks->density = select(walks->density, select(sample.density, zero, sample.specular), turns);
  walks->from = select3(walks->from, at->s.p, turns);
  MASK going = some & MASK_OF(walks->depth <= (int)scene->info->max_depth);
  counts[COUNT_DEPTH_LIMIT] += lane_count(some & ~going);
  going = play_roulette(scene, walks, u.w, going);
  walks->depth -= lanes;
  counts[COUNT_REFRACTION] += lane_count(going & below);
  counts[COUNT_REFLECTION] += lane_count(going & ~below);
  leave_surfaces(scene, met, at, &sample, below, going, rays);
  return going;
}

// Takes the paths of `lanes` a step further. Returns those that continue; the light of the others is
// complete. `coherent`: their rays run close together.
NEVER_INLINE MASK step_walks(const Scene* scene, Walks* walks, SceneRays* rays, MASK lanes, bool coherent,
                             u32* counts) {
  Encounters met;
  const MASK unseen = next_interfaces(scene, rays, lanes, coherent, &met, counts);
  if (HAS_GLOW)
    walks->light =
        select3(walks->light, add3(walks->light, multiply3(walks->throughput, emitted(rays))), lanes);
  forget_glow(rays);
  walks->throughput = select3(walks->throughput, multiply3(walks->throughput, met.absorbed), lanes);
  // An interface that cannot be seen may stop shadow rays all the same.
  walks->density = select(walks->density, (REAL)(0.0f),
                          unseen & MASK_OF((met.face.flags & (int)MATERIAL_SHADOW_OPAQUE) != 0));
  const MASK ended = lanes & ~unseen, hit = ended & hit_anything(&met.hit), lost = ended & ~hit;
  REAL3 light = all3((float3)(0.0f));
  if (HAS_FOG) light = met_fog(scene, &met, ended, &walks->throughput);
  if (any_lane(lost))
    light =
        select3(light, add3(light, multiply3(walks->throughput, met_sky(scene, walks, rays->d, lost))), lost);
  MASK going = unseen;
  if (any_lane(hit)) {
    Shading at;
    const MASK first = hit & MASK_OF(walks->depth == 1);
    counts[COUNT_PRIMARY_HIT] += lane_count(first);
    walks->met |= first;
    shade_hits(scene, rays, &met, hit, &at);
    light = select3(
        light, add3(light, multiply3(walks->throughput, met_surface(scene, walks, rays, &met.hit, &at, hit))),
        hit);
    const MASK scattering = hit & MASK_OF(walks->depth <= (int)scene->info->max_depth);
    const Lobes lobes = make_lobes(scene, &at.bsdf, negate3(rays->d), scattering);
    const MASK open = scattering & MASK_OF(lobes.matte + lobes.glossy + lobes.facets > 0.0f);
    if (scene->info->light_count && any_lane(open)) {
      const FourNumbers u = sample_lanes(&walks->at, (walks->depth - 1) * (int)DIMENSIONS_A_BOUNCE +
                                                         (int)(DIMENSION_BOUNCE + BOUNCE_LIGHT_POINT));
      light = add3(light, next_event(scene, walks, rays, &met, &at, &lobes, &u, open, counts));
    }
    if (any_lane(scattering)) going |= scatter(scene, &met, &at, &lobes, walks, rays, scattering, counts);
  }
  walks->light = select3(walks->light, add3(walks->light, light), ended);
  return going;
}

#endif
