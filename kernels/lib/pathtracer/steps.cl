// One step of a batch of paths: each ray to the next interface, the light that it meets there, the light
// chosen there, and the ray that continues. Nothing waits: a path is its one ray and its Walks.
#ifndef SUNDOG_LIB_PATH_STEPS_CL
#define SUNDOG_LIB_PATH_STEPS_CL
#include "lib/path/ray_counts.cl"
#include "lib/pathtracer/gather_photons.cl"
#include "lib/pathtracer/guides.cl"
#include "lib/pathtracer/leave_surfaces.cl"
#include "lib/pathtracer/met_light.cl"
#include "lib/pathtracer/next_event.cl"
#include "lib/pathtracer/scatter_media.cl"

// Surfaces of `lanes` scatter: the paths' next rays. Returns the paths that continue. Those of `free` are not
// there, and no surfaces for max_depth.
NEVER_INLINE MASK scatter(const Scene* scene, const Encounters* met, const Shading* at, const Lobes* lobes,
                          Walks* walks, SceneRays* rays, MASK free, MASK lanes, u32* counts) {
  const REAL zero = (REAL)(0.0f), one = (REAL)(1.0f);
  const MASK dimension = dimension_here(walks, BOUNCE_DIRECTION);
  // Matte surfaces have one lobe.
  const bool chooses = HAS_GUIDES || any_lane(lanes & MASK_OF(lobes->matte != lobes->all));
  const FourNumbers u = wanted_lanes(&walks->at, dimension, true, chooses);
  const REAL3 wo = negate3(rays->d);
  const BsdfSamples sample =
      sample_guided(scene, &at->bsdf, lobes, at->s.p, wo, u.z, u.x, u.y, lanes, &walks->spread);
  const MASK some = lanes & MASK_OF(greatest3(sample.weight) > 0.0f);
  const MASK below = some & MASK_OF(dot3(at->s.ng, sample.wi) < 0.0f);
  walks->throughput =
      carry_select(walks->throughput,
                   carry_multiply(walks->throughput, carry_color(&walks->wavelengths, sample.weight)), lanes);
  part_wavelengths(scene, at, &lobes->split, walks, some, some & sample.specular & ~below);
  if (HAS_RELIEF)
    walks->throughput = carry_scale(
        walks->throughput, select(one, terminator(&at->s, sample.wi), lanes & ~below & ~sample.specular));
  if (HAS_MEDIA) {
    const REAL eta = select(one, lobes->split.eta, below), square = eta * eta;
    walks->throughput = carry_scale(walks->throughput, 1.0f / square);
    walks->spread *= square;
  }
  // Shadow rays go through filters as the path does: what it was about to find, it still is.
  const MASK passes = below & sample.specular & MASK_OF((at->bsdf.flags & (int)MATERIAL_SHADOW_OPAQUE) == 0);
  const MASK turns = lanes & ~passes;
  walks->density = select(walks->density, select(sample.density, zero, sample.specular), turns);
  walks->from = select3(walks->from, at->s.p, turns);
  leave_stretch(walks, turns);
  note_gathered(walks, sample.specular, narrow_part(scene, &at->bsdf, lobes, wo, &sample, lanes), turns);
  walks->straight &= ~lanes | (below & sample.specular & MASK_OF(lobes->split.eta == 1.0f));
  const MASK going = free | play_roulette(scene, walks, dimension, some & ~free);
  walks->depth -= lanes & ~free;
  counts[COUNT_REFRACTION] += lane_count(going & below);
  counts[COUNT_REFLECTION] += lane_count(going & ~below);
  note_own_rays(going, counts);
  leave_surfaces(scene, met, at, &sample, below, free, going, rays);
  return going;
}

// Takes the paths of `lanes` a step further. Returns those that continue; the light of the others is
// complete. `coherent`: their rays run close together.
NEVER_INLINE MASK step_walks(const Scene* scene, Walks* walks, SceneRays* rays, MASK lanes, bool coherent,
                             u32* counts) {
  Encounters met;
  const BegunRays begun = begun_rays_of(rays);
  MASK crossing = meet_interfaces(scene, rays, lanes, coherent, &met, counts);
  crossing |= pass_hidden(scene, rays, &met, lanes & ~crossing & MASK_OF(walks->depth == 1));
  if (HAS_GLOW)
    walks->light =
        carry_select(walks->light, carry_add(walks->light, carried_color(walks, emitted(rays))), lanes);
  forget_glow(rays);
  MASK going;
  const MASK scattered = scatter_in_media(scene, walks, &begun, rays, &met, lanes, &going, counts);
  const MASK there = lanes & ~scattered, unseen = crossing & there;
  walks->throughput =
      carry_select(walks->throughput,
                   carry_multiply(walks->throughput, carry_kept(&walks->wavelengths, met.absorbed)), there);
  // An interface that cannot be seen may stop shadow rays all the same.
  walks->density = select(walks->density, (REAL)(0.0f),
                          unseen & MASK_OF((met.face.flags & (int)MATERIAL_SHADOW_OPAQUE) != 0));
  const MASK ended = there & ~unseen, hit = ended & hit_anything(&met.hit), lost = ended & ~hit;
  Carried light = carry_all(0.0f);
  if (HAS_FOG) light = met_fog(scene, &met, ended, walks);
  if (any_lane(lost))
    light = carry_select(light, carry_add(light, carried_color(walks, met_sky(scene, walks, rays->d, lost))),
                         lost);
  going |= unseen;
  if (any_lane(hit)) {
    Shading at;
    shade_hits(scene, rays, &met, hit, &at);
    follow_hero(&walks->wavelengths, &at.bsdf);
    const REAL3 shining = met_surface(scene, walks, rays, &met.hit, &at, hit);
    light = carry_select(light, carry_add(light, carried_color(walks, shining)), hit);
    const MASK deep = hit & MASK_OF(walks->depth > (int)scene->info->max_depth), scattering = hit & ~deep;
    const MASK passing = HAS_SHADOW_FILTERS ? of_kind(&at.bsdf, MATERIAL_TRANSMITS, hit) : NO_LANES;
    const Lobes lobes = make_lobes(scene, &at.bsdf, negate3(rays->d), scattering | passing);
    const MASK nothing = cut_away(&at.bsdf, &lobes.split, passing), free = nothing & may_cross(rays);
    const MASK first = hit & ~nothing & MASK_OF(walks->depth == 1), open = scattering & scatters(&lobes);
    const MASK ending = deep & ~free & MASK_OF((at.bsdf.flags & (int)MATERIAL_EMITS) == 0);
    counts[COUNT_PRIMARY_HIT] += lane_count(first);
    counts[COUNT_DEPTH_LIMIT] += lane_count(ending);
    counts[COUNT_CAMERA_DEPTH_LIMIT] += lane_count(ending & walks->straight);
    walks->met |= first;
    if (scene->info->light_count && any_lane(open)) {
      const bool chooses = HAS_LIGHT_TREE || scene->info->light_count > 1u;
      const FourNumbers u =
          wanted_lanes(&walks->at, dimension_here(walks, BOUNCE_LIGHT_POINT), true, chooses);
      Carried chosen = next_event(scene, walks, rays, &met, &at, &lobes, &u, open, counts);
      keep_hero(scene, &at, &lobes.split, walks, &chosen, open);
      light = carry_add(light, chosen);
    }
    if (HAS_CAUSTICS && any_lane(open)) {
      Carried brought = gather_photons(scene, walks, rays, &at, &lobes, open);
      keep_hero(scene, &at, &lobes.split, walks, &brought, open);
      light = carry_add(light, brought);
    }
    const MASK leaving = scattering | free;
    if (any_lane(leaving)) going |= scatter(scene, &met, &at, &lobes, walks, rays, free, leaving, counts);
  }
  walks->light = carry_select(walks->light, carry_add(walks->light, light), ended);
  return going;
}

#endif
