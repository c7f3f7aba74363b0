// Whitted's ray tree (Whitted 1980) walked with an explicit stack: the BATCH pixels of a work-item share it,
// so that the newest BATCH rays are taken together. What a pixel receives is added in an order that depends
// on nothing but those pixels.
#ifndef SUNDOG_LIB_WHITTED_CL
#define SUNDOG_LIB_WHITTED_CL
#include "lib/camera.cl"
#include "lib/lights.cl"
#include "lib/segment.cl"
#include "lib/shadow.cl"

// What a ray carries besides its way.
typedef struct PathState {
  float3 throughput;
  u32 pixel;  // in the work-item's tile
  u32 depth;  // the camera's ray has 1
} PathState;

// The rays that wait.

typedef struct RayStack {
  SceneRay rays[RAY_STACK];
  PathState paths[RAY_STACK];
  u32 count;
} RayStack;

static inline float greatest(float3 v) { return fmax(v.x, fmax(v.y, v.z)); }

// Puts a child on the stack unless it is too weak, too deep or there is no room; each case is counted.
static inline void spawn(RayStack* stack, const SceneRay* ray, const PathState* path,
                         __global const SceneInfo* restrict info, u32 kind, u32* counts) {
  const float weight = greatest(path->throughput);
  if (!(weight > 0.0f)) return;
  if (path->depth > info->max_depth)
    counts[COUNT_DEPTH_LIMIT] += 1u;
  else if (weight < info->cutoff)
    counts[COUNT_CUT_OFF] += 1u;
  else if (stack->count == RAY_STACK)
    counts[COUNT_RAY_STACK_OVERFLOW] += 1u;
  else {
    counts[kind] += 1u;
    stack->rays[stack->count] = *ray;
    stack->paths[stack->count++] = *path;
  }
}

// What the rays of a batch met.
typedef struct BatchSurfaces {
  Encounter met[BATCH];
  SurfaceInteraction surface[BATCH];  // where met[i].hit.instance is not NO_INSTANCE
  float3 own_light[BATCH];            // light that the surface itself sends back along the ray
} BatchSurfaces;

// Adds what one light does to every surface of the batch: Ij (kd n.l + ks (r.v)^b) Vj. `coherent`: the points
// lie close together.
static inline void add_light(TRACE_PARAMETERS, SHADE_PARAMETERS, u32 index, const SceneRay* rays,
                             u32 ray_count, bool coherent, BatchSurfaces* batch, u32* counts) {
  SceneRay to_light[BATCH];
  float3 possible[BATCH], through[BATCH];
  u32 lit[BATCH], lit_count = 0;
  for (u32 i = 0; i < ray_count; ++i) {
    if (batch->met[i].hit.instance == NO_INSTANCE) continue;
    const SurfaceInteraction* s = &batch->surface[i];
    const LightSample light = sample_light(lights + index, s->p);
    if (!(dot(s->ns, light.wi) > 0.0f)) continue;
    const float3 radiance =
        light.radiance * local_reflection(materials + s->material, s, rays[i].d, light.wi);
    if (!(greatest(radiance) > 0.0f)) continue;
    SceneRay* ray = &to_light[lit_count];
    *ray = rays[i];
    start_on_surface(info, instances, ray, &batch->met[i].hit, !s->entering);
    ray->o = s->p + s->offset * s->ng;
    ray->d = light.wi;
    ray->t_min = 0.0f;
    ray->t_max = light.distance;
    possible[lit_count] = radiance;
    lit[lit_count++] = i;
  }
  counts[COUNT_SHADOW] += lit_count;
  if (!lit_count) return;
  visibilities(TRACE_ARGUMENTS, SHADE_ARGUMENTS, to_light, lit_count, coherent, through, counts);
  for (u32 k = 0; k < lit_count; ++k) batch->own_light[lit[k]] += possible[k] * through[k];
}

// The two children of a surface: kr I(reflected) + kt I(transmitted).
static inline void spawn_children(TRACE_PARAMETERS, SHADE_PARAMETERS, const SurfaceInteraction* s,
                                  const Encounter* e, const SceneRay* ray, const PathState* path,
                                  RayStack* stack, u32* counts) {
  __global const Material* material = materials + s->material;
  if (!(material->flags & (MATERIAL_REFLECTS | MATERIAL_TRANSMITS))) return;
  float3 kr = material->reflection.xyz, kt = material->transmission.xyz;
  const bool transmits = material->flags & MATERIAL_TRANSMITS, thin = material->flags & MATERIAL_THIN;
  const float eta = transmits && !thin ? relative_index(media, e) : 1.0f;
  const float cos_i = clamp(-dot(s->ns, ray->d), 0.0f, 1.0f), cos_t = refracted_cosine(cos_i, eta);
  if (material->kind == MATERIAL_DIELECTRIC) {
    const float f = thin ? 0.0f : fresnel_reflectance(cos_i, cos_t, eta);
    kr *= f;
    kt *= 1.0f - f;
  } else if (transmits && cos_t <= 0.0f) {  // total internal reflection turns everything into reflection
    kr += kt;
    kt = (float3)(0.0f);
  }
  SceneRay child = *ray;
  PathState state = *path;
  state.depth = path->depth + 1u;
  child.t_min = 0.0f;
  child.t_max = INFINITY;
  start_on_surface(info, instances, &child, &e->hit, !s->entering);

  child.d = reflect_direction(ray->d, s->ns);
  if (!(dot(child.d, s->ng) > 0.0f))
    child.d = reflect_direction(ray->d, s->ng);  // a shading normal must not send it inside
  child.o = s->p + s->offset * s->ng;
  state.throughput = path->throughput * kr;
  spawn(stack, &child, &state, info, COUNT_REFLECTION, counts);

  if (!transmits) return;
  child.d = ray->d;
  if (eta != 1.0f) {
    child.d = refract_direction(ray->d, s->ns, cos_i, cos_t, eta);
    if (!(dot(child.d, s->ng) < 0.0f)) {
      const float cos_g = clamp(-dot(s->ng, ray->d), 0.0f, 1.0f);
      child.d = refract_direction(ray->d, s->ng, cos_g, refracted_cosine(cos_g, eta), eta);
    }
  }
  child.o = s->p - s->offset * s->ng;
  state.throughput = path->throughput * kt;
  start_on_hit(instances, &child, &e->hit, s->entering);
#if HAS_MEDIA
  if (!thin) cross_boundary(&child.media, material->medium, e->entering);
#endif
  spawn(stack, &child, &state, info, COUNT_REFRACTION, counts);
}

#if HAS_SDF
// Fields take ambient light from their own crevices.
static inline void dim_crevices(TRACE_PARAMETERS, SHADE_PARAMETERS, const SceneRay* rays, u32 ray_count,
                                BatchSurfaces* batch) {
  Hit hits[BATCH];
  float open[BATCH];
  for (u32 i = 0; i < ray_count; ++i) hits[i] = batch->met[i].hit;
  field_openness(TRACE_ARGUMENTS, SHADE_ARGUMENTS, rays, hits, ray_count, open);
  for (u32 i = 0; i < ray_count; ++i)
    if (hits[i].instance != NO_INSTANCE) batch->own_light[i] *= open[i];
}
#endif

#if HAS_FOG
// What the fog adds to a ray's light over `distance`, by which it weakens what comes from behind.
static inline float3 go_through_fog(__global const SceneInfo* restrict info, float3* throughput,
                                    float distance) {
  const float kept = exp(-info->fog.w * distance);
  const float3 added = *throughput * (1.0f - kept) * info->fog.xyz;
  *throughput *= kept;
  return added;
}
#endif

// Takes a batch to the next surfaces, adds what it sees there to the pixels and leaves the children on the
// stack.
static inline void follow_batch(TRACE_PARAMETERS, SHADE_PARAMETERS, SceneRay* rays, PathState* paths,
                                u32 ray_count, RayStack* stack, float4* radiance, u32* counts) {
  BatchSurfaces batch;
  const bool coherent = paths[0].depth == 1u;
  next_surfaces(TRACE_ARGUMENTS, SHADE_ARGUMENTS, rays, ray_count, coherent, batch.met, counts);
  for (u32 i = 0; i < ray_count; ++i) {
#if HAS_GLOW
    radiance[paths[i].pixel].xyz += paths[i].throughput * rays[i].glow;
#endif
    paths[i].throughput *= batch.met[i].absorbed;
#if HAS_FOG
    if (batch.met[i].before == 0u)
      radiance[paths[i].pixel].xyz += go_through_fog(info, &paths[i].throughput, batch.met[i].hit.t);
#endif
    if (batch.met[i].hit.instance == NO_INSTANCE) continue;
    batch.surface[i] = interact(TRACE_ARGUMENTS, SHADE_ARGUMENTS, rays[i].o, rays[i].d, &batch.met[i].hit);
    batch.own_light[i] = batch.surface[i].ambient * info->ambient.xyz;
  }
#if HAS_SDF
  dim_crevices(TRACE_ARGUMENTS, SHADE_ARGUMENTS, rays, ray_count, &batch);
#endif
  for (u32 light = 0; light < info->light_count; ++light)
    add_light(TRACE_ARGUMENTS, SHADE_ARGUMENTS, light, rays, ray_count, coherent, &batch, counts);
  for (u32 i = 0; i < ray_count; ++i) {
    const PathState* path = &paths[i];
    float4* pixel = &radiance[path->pixel];
    if (batch.met[i].hit.instance == NO_INSTANCE) {
      pixel->xyz += path->throughput * background_along(info, rays[i].d);
      continue;
    }
    if (path->depth == 1u) {
      counts[COUNT_PRIMARY_HIT] += 1u;
      pixel->w = 1.0f;
    }
    pixel->xyz += path->throughput * batch.own_light[i];
#if HAS_SECONDARY
    spawn_children(TRACE_ARGUMENTS, SHADE_ARGUMENTS, &batch.surface[i], &batch.met[i], &rays[i], path, stack,
                   counts);
#endif
  }
}

// Empties the stack. radiance[i].xyz receives the light of pixel i of the tile, w whether its camera ray hit
// anything.
static inline void trace_whitted(TRACE_PARAMETERS, SHADE_PARAMETERS, RayStack* stack, float4* radiance,
                                 u32* counts) {
  while (stack->count) {
    SceneRay rays[BATCH];
    PathState paths[BATCH];
    const u32 ray_count = min(stack->count, (u32)BATCH);
    stack->count -= ray_count;
    for (u32 i = 0; i < ray_count; ++i) {
      rays[i] = stack->rays[stack->count + i];
      paths[i] = stack->paths[stack->count + i];
    }
    follow_batch(TRACE_ARGUMENTS, SHADE_ARGUMENTS, rays, paths, ray_count, stack, radiance, counts);
  }
}

#endif
