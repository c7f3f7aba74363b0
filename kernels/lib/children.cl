// What rays do at the surfaces that they meet: light that they see there, shadow rays to the lights, and the
// reflected and refracted rays that come of them (Whitted 1980). Rays are left on stacks.
#ifndef SUNDOG_LIB_CHILDREN_CL
#define SUNDOG_LIB_CHILDREN_CL
#include "lib/camera.cl"
#include "lib/lights.cl"
#include "lib/ray_stack.cl"
#include "lib/segment.cl"
#include "lib/shadow.cl"

// Sends shadow rays from the surfaces of `lanes` to one light, with what it would do there: Ij (kd n.l +
// ks (r.v)^b) Vj.
static inline void cast_shadows(const Scene* scene, u32 index, const SceneRays* rays, const PathStates* paths,
                                MASK lanes, const Encounters* met, const Surfaces* s, ShadowStack* stack,
                                u32* counts) {
  const LightSamples light = sample_light(scene->lights + index, s->p);
  const MASK facing = lanes & MASK_OF(dot3(s->ns, light.wi) > 0.0f);
  if (!any_lane(facing)) return;
  const REAL3 possible =
      multiply3(light.radiance, local_reflection(scene->materials, &met->face, s, rays->d, light.wi, facing));
  // A high power of (r.v) may leave less than the least normal float, which some devices take for zero: not
  // worth a ray.
  const MASK lit = facing & MASK_OF(greatest3(possible) >= FLT_MIN);
  if (!any_lane(lit)) return;
  counts[COUNT_SHADOW] += lane_count(lit);
  SceneRays to_light = *rays;
  start_on_surfaces(scene->info, &to_light, &met->hit, ~met->face.entering, lit);
  to_light.o = along3(s->p, s->offset, s->ng);
  to_light.d = light.wi;
  to_light.t_min = (REAL)(0.0f);
  to_light.t_max = light.distance;
  PathStates weights = *paths;
  weights.depth = NO_LANES;
  weights.throughput = multiply3(paths->throughput, possible);
#if HAS_SOFT_SHADOWS
  weights.throughput = scale3(weights.throughput, soft_shadows(scene, &to_light, lit, counts));
#endif
  push_shadows(stack, &to_light, &weights, lit);
}

#if HAS_SECONDARY
// Puts children on the stack, those of `lanes` that are not too weak, nor too deep, nor without room; each
// case is counted.
NEVER_INLINE void spawn(__global const SceneInfo* restrict info, RayStack* stack, const SceneRays* rays,
                        const PathStates* paths, MASK lanes, u32 kind, u32* counts) {
  const REAL weight = greatest3(paths->throughput);
  const MASK some = lanes & MASK_OF(weight > 0.0f);
  const MASK deep = some & MASK_OF(paths->depth > (int)info->max_depth);
  const MASK weak = some & ~deep & MASK_OF(weight < info->cutoff);
  u32 bits = lane_bits(some & ~deep & ~weak);
  counts[COUNT_DEPTH_LIMIT] += lane_count(deep);
  counts[COUNT_CUT_OFF] += lane_count(weak);
  while (stack->count + popcount(bits) > RAY_STACK) {
    counts[COUNT_RAY_STACK_OVERFLOW] += 1u;
    bits &= bits - 1u;
  }
  if (!bits) return;
  counts[kind] += popcount(bits);
  push_rays(stack, rays, paths, lanes_of(bits));
}

// kr and kt of surfaces.
typedef struct Splits {
  REAL3 kr, kt;
  MASK branches, dielectric;  // branches: reflects or transmits at all
} Splits;

static inline Splits split_light(__global const Material* restrict materials, const Faces* faces,
                                 MASK lanes) {
  const REAL3 none = all3((float3)(0.0f));
  Splits split = {none, none, NO_LANES, NO_LANES};
  u32 index;
  while (any_lane(lanes)) {
    const MASK mine = take_alike(faces->material, &lanes, &index);
    __global const Material* material = materials + index;
    if (!(material->flags & (MATERIAL_REFLECTS | MATERIAL_TRANSMITS))) continue;
    split.kr = select3(split.kr, all3(material->reflection.xyz), mine);
    split.kt = select3(split.kt, all3(material->transmission.xyz), mine);
    split.branches |= mine;
    if (material->kind == MATERIAL_DIELECTRIC) split.dielectric |= mine;
  }
  return split;
}

// The refracted directions; a shading normal must not send them outside again.
static inline REAL3 transmitted_direction(REAL3 d, const Surfaces* s, REAL cos_i, REAL cos_t, REAL eta) {
  const REAL3 by_shading = refract_direction(d, s->ns, cos_i, cos_t, eta);
  const MASK good = MASK_OF(dot3(by_shading, s->ng) < 0.0f), straight = MASK_OF(eta == 1.0f);
  const REAL cos_g = real_clamp(-dot3(s->ng, d), (REAL)(0.0f), (REAL)(1.0f));
  const REAL3 by_face = refract_direction(d, s->ng, cos_g, refracted_cosine(cos_g, eta), eta);
  return select3(select3(by_face, by_shading, good), d, straight);
}

// The children of the surfaces of `lanes`: kr I(reflected) + kt I(transmitted).
static inline void spawn_children(const Scene* scene, const Surfaces* s, const Encounters* met,
                                  const SceneRays* rays, const PathStates* paths, MASK lanes, RayStack* stack,
                                  u32* counts) {
  const Faces* faces = &met->face;
  Splits split = split_light(scene->materials, faces, lanes);
  if (!any_lane(split.branches)) return;
  const MASK transmits = split.branches & MASK_OF((faces->flags & (int)MATERIAL_TRANSMITS) != 0);
  const MASK bends = transmits & MASK_OF((faces->flags & (int)MATERIAL_THIN) == 0);
  REAL eta = (REAL)(1.0f), cos_t = (REAL)(1.0f);
  const REAL cos_i = real_clamp(-dot3(s->ns, rays->d), (REAL)(0.0f), (REAL)(1.0f));
  if (any_lane(transmits | split.dielectric)) {
    eta = relative_index(scene->media, met, bends);
    cos_t = refracted_cosine(cos_i, eta);
    const REAL f = select((REAL)(0.0f), fresnel_reflectance(cos_i, cos_t, eta), bends);
    // Total internal reflection turns everything into reflection.
    const MASK total = transmits & ~split.dielectric & MASK_OF(cos_t <= 0.0f);
    split.kr = select3(split.kr, add3(split.kr, split.kt), total);
    split.kt = select3(split.kt, all3((float3)(0.0f)), total);
    split.kr = select3(split.kr, scale3(split.kr, f), split.dielectric);
    split.kt = select3(split.kt, scale3(split.kt, 1.0f - f), split.dielectric);
  }
  SceneRays child = *rays;
  child.t_min = (REAL)(0.0f);
  child.t_max = (REAL)(INFINITY);
  PathStates state = *paths;
  state.depth = paths->depth + 1;
  start_on_surfaces(scene->info, &child, &met->hit, ~faces->entering, split.branches);
  child.d = reflect_direction(rays->d, s->ns);
  // A shading normal must not send it inside.
  child.d = select3(reflect_direction(rays->d, s->ng), child.d, MASK_OF(dot3(child.d, s->ng) > 0.0f));
  child.o = along3(s->p, s->offset, s->ng);
  state.throughput = multiply3(paths->throughput, split.kr);
  spawn(scene->info, stack, &child, &state, split.branches, COUNT_REFLECTION, counts);

  if (!any_lane(transmits)) return;
  child.d = transmitted_direction(rays->d, s, cos_i, cos_t, eta);
  child.o = along3(s->p, -s->offset, s->ng);
  state.throughput = multiply3(paths->throughput, split.kt);
  start_on_hits(scene->info, &child, &met->hit, faces->entering, transmits);
#if HAS_TOUCHING
  child.media_low = select(child.media_low, met->behind_low, transmits);
  child.media_high = select(child.media_high, met->behind_high, transmits);
#elif HAS_MEDIA
  for (u32 bits = lane_bits(bends); bits; bits &= bits - 1u) {
    const u32 i = lowest_bit(bits);
    MediaStack crossed = get_media(rays, i);
    cross_boundary(&crossed, (u32)MASK_LANE(faces->medium, i), MASK_LANE(faces->entering, i));
    set_media(&child, i, crossed);
  }
#endif
  spawn(scene->info, stack, &child, &state, transmits, COUNT_REFRACTION, counts);
}
#endif

// The rays of `lanes` at what they met: the surfaces of those that hit something, which are returned, and
// what the `fresh` ones see and spawn there. The rays of `unseen` saw only what lay before.
static inline MASK look_around(const Scene* scene, const SceneRays* rays, PathStates* paths, MASK lanes,
                               MASK unseen, MASK fresh, const Encounters* met, Surfaces* s, REAL3* light,
                               RayStack* stack, float4* radiance, u32* counts) {
  REAL3 seen = all3((float3)(0.0f));
#if HAS_GLOW
  seen = multiply3(paths->throughput, rays->glow);
#endif
  paths->throughput = multiply3(paths->throughput, met->absorbed);
#if HAS_MEDIA && BATCH > 1
  if (any_lane(unseen)) push_rays(stack, rays, paths, unseen);
#endif
  const MASK ended = lanes & ~unseen, hit = ended & hit_anything(&met->hit);
#if HAS_FOG
  const MASK foggy = ended & MASK_OF(met->before == 0);
  const REAL clear = select((REAL)(1.0f), real_exp(-scene->info->fog.w * met->hit.t), foggy);
  seen = add3(seen, multiply3(scale3(paths->throughput, 1.0f - clear), all3(scene->info->fog.xyz)));
  paths->throughput = scale3(paths->throughput, clear);
#endif
  const REAL3 background = multiply3(paths->throughput, background_along(scene->info, rays->d));
  seen = select3(seen, add3(seen, background), ended & ~hit);
  if (any_lane(hit)) {
    interact(scene, rays->o, rays->d, &met->hit, &met->face, hit, s);
#if HAS_TOUCHING
    s->offset = real_max(s->offset, met->apart);
#endif
    REAL3 own = multiply3(s->ambient, all3(scene->info->ambient.xyz));
#if HAS_OCCLUSION
    own = scale3(own, field_openness(scene, rays, &met->hit, hit));
#endif
    seen = select3(seen, add3(seen, multiply3(paths->throughput, own)), hit);
#if HAS_SECONDARY
    spawn_children(scene, s, met, rays, paths, hit & fresh, stack, counts);
#endif
    const MASK first = hit & fresh & MASK_OF(paths->depth == 1);
    counts[COUNT_PRIMARY_HIT] += lane_count(first);
    for (u32 bits = lane_bits(first); bits; bits &= bits - 1u)
      radiance[MASK_LANE(paths->pixel, lowest_bit(bits))].w = 1.0f;
  }
  *light = seen;
  return hit;
}

#endif
