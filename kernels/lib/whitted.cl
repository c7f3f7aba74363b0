// Whitted's ray tree (Whitted 1980) walked with an explicit stack: the BATCH pixels of a work-item share it,
// so that the newest BATCH rays are taken together. What a pixel receives is added in an order that depends
// on nothing but those pixels.
#ifndef SUNDOG_LIB_WHITTED_CL
#define SUNDOG_LIB_WHITTED_CL
#include "lib/camera.cl"
#include "lib/lights.cl"
#include "lib/segment.cl"
#include "lib/shadow.cl"

// A ray that waits.
typedef struct PathRay {
  float3 o, d;  // d unit
  float3 throughput;
  float t_min, t_max;
  u32 pixel;  // in the work-item's tile
  u32 depth;  // the camera's ray has 1
  MediaStack media;
} PathRay;

typedef struct RayStack {
  PathRay rays[RAY_STACK];
  u32 count;
} RayStack;

static inline float greatest(float3 v) { return fmax(v.x, fmax(v.y, v.z)); }

// Puts a child on the stack unless it is too weak, too deep or there is no room; each case is counted.
static inline void spawn(RayStack* stack, const PathRay* child, __global const SceneInfo* restrict info,
                         u32 kind, u32* counts) {
  const float weight = greatest(child->throughput);
  if (!(weight > 0.0f)) return;
  if (child->depth > info->max_depth)
    counts[COUNT_DEPTH_LIMIT] += 1u;
  else if (weight < info->cutoff)
    counts[COUNT_CUT_OFF] += 1u;
  else if (stack->count == RAY_STACK)
    counts[COUNT_RAY_STACK_OVERFLOW] += 1u;
  else {
    counts[kind] += 1u;
    stack->rays[stack->count++] = *child;
  }
}

// Ambient and local reflection of every light in sight: the first terms of I = ka Ia + sum Ij (kd n.l + ks
// (r.v)^b) Vj.
static inline float3 local_light(TRACE_PARAMETERS, SHADE_PARAMETERS, const SurfaceInteraction* s,
                                 const PathRay* ray, u32* counts) {
  __global const Material* material = materials + s->material;
  float3 sum = s->ambient * info->ambient.xyz;
  for (u32 i = 0; i < info->light_count; ++i) {
    const LightSample light = sample_light(lights + i, s->p);
    if (!(dot(s->ns, light.wi) > 0.0f)) continue;
    const float3 possible = light.radiance * local_reflection(material, s, ray->d, light.wi);
    if (!(greatest(possible) > 0.0f)) continue;
    counts[COUNT_SHADOW] += 1u;
    sum += possible * visibility(TRACE_ARGUMENTS, SHADE_ARGUMENTS, s->p + s->offset * s->ng, light.wi,
                                 light.distance, ray->media, counts);
  }
  return sum;
}

// The two children of a surface: kr I(reflected) + kt I(transmitted).
static inline void spawn_children(TRACE_PARAMETERS, SHADE_PARAMETERS, const SurfaceInteraction* s,
                                  const Encounter* e, const PathRay* ray, RayStack* stack, u32* counts) {
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
  PathRay child = *ray;
  child.depth = ray->depth + 1u;
  child.t_min = 0.0f;
  child.t_max = INFINITY;

  child.d = reflect_direction(ray->d, s->ns);
  if (!(dot(child.d, s->ng) > 0.0f))
    child.d = reflect_direction(ray->d, s->ng);  // a shading normal must not send it inside
  child.o = s->p + s->offset * s->ng;
  child.throughput = ray->throughput * kr;
  spawn(stack, &child, info, COUNT_REFLECTION, counts);

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
  child.throughput = ray->throughput * kt;
#if HAS_MEDIA
  if (!thin) cross_boundary(&child.media, material->medium, e->entering);
#endif
  spawn(stack, &child, info, COUNT_REFRACTION, counts);
}

// Takes one ray to the next surface, adds what it sees there to its pixel and leaves its children on the
// stack.
static inline void trace_path_ray(TRACE_PARAMETERS, SHADE_PARAMETERS, PathRay* ray, RayStack* stack,
                                  float4* radiance, u32* counts) {
  const Encounter e = next_surface(TRACE_ARGUMENTS, SHADE_ARGUMENTS, ray->o, ray->d, ray->t_min, ray->t_max,
                                   &ray->media, counts);
  ray->throughput *= e.absorbed;
  if (e.hit.instance == NO_INSTANCE) {
    radiance[ray->pixel].xyz += ray->throughput * background_along(info, ray->d);
    return;
  }
  if (ray->depth == 1u) {
    counts[COUNT_PRIMARY_HIT] += 1u;
    radiance[ray->pixel].w = 1.0f;
  }
  const SurfaceInteraction s = interact(TRACE_ARGUMENTS, SHADE_ARGUMENTS, ray->o, ray->d, &e.hit);
  radiance[ray->pixel].xyz +=
      ray->throughput * local_light(TRACE_ARGUMENTS, SHADE_ARGUMENTS, &s, ray, counts);
#if HAS_SECONDARY
  spawn_children(TRACE_ARGUMENTS, SHADE_ARGUMENTS, &s, &e, ray, stack, counts);
#endif
}

// Empties the stack. radiance[i].xyz receives the light of pixel i of the tile, w whether its camera ray hit
// anything.
static inline void trace_whitted(TRACE_PARAMETERS, SHADE_PARAMETERS, RayStack* stack, float4* radiance,
                                 u32* counts) {
  while (stack->count) {
    PathRay batch[BATCH];
    const u32 taken = min(stack->count, (u32)BATCH);
    stack->count -= taken;
    for (u32 i = 0; i < taken; ++i) batch[i] = stack->rays[stack->count + i];
    for (u32 i = 0; i < taken; ++i)
      trace_path_ray(TRACE_ARGUMENTS, SHADE_ARGUMENTS, &batch[i], stack, radiance, counts);
  }
}

#endif
