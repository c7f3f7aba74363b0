// How photons leave the lights: towards the balls about what mirrors and bends light. A photon's density is
// that of all balls together, so that one that might have been sent to several counts for each (the balance
// heuristic of Veach and Guibas 1995 with one sample).
#pragma once
#include "lib/core/directions.cl"
#include "lib/light/environment.cl"
#include "lib/pathtracer/numbers.cl"
#include "lib/pathtracer/photon_cells.cl"
#include "plain/light/emission.cl"

#define NOT_DIMMED (-1)
#define OFF_LIGHT 0x1p-17f  // how far photons start off a light's surface, of its place's greatest coordinate

// Photons as they start.
typedef struct PhotonStarts {
  REAL3 o, d;
  REAL time;    // of moving objects, from 0 to 1
  REAL3 flux;   // for one photon; of lights without extent, of a factor that dim_with_distance() knows
  MASK lanes;   // those that carry light
  MASK light;   // index of the one that each comes from
  MASK dimmed;  // the light whose distance counts where the photon is first bent, or NOT_DIMMED
} PhotonStarts;

// One photon, and the numbers in [0, 1) that it is made of: a and b choose the place in a ball, c and e that
// on a light.
typedef struct PhotonStart {
  float3 o, d, flux;
  u32 light;
  int dimmed;
} PhotonStart;
typedef struct PhotonNumbers {
  float light, ball, a, b, c, e;
} PhotonNumbers;

// The light by the number u, and its share.
static inline u32 choose_photon_light(const Scene* scene, float u, float* share) {
  __global const float* sums = scene->photon_lights;
  u32 low = 0, high = scene->info->table_lights - 1u;
  while (low < high) {
    const u32 middle = (low + high) / 2u;
    if (sums[middle] <= u)
      low = middle + 1u;
    else
      high = middle;
  }
  *share = sums[low] - (low ? sums[low - 1u] : 0.0f);
  return low;
}

// Planes follow the balls in the table, with a weight below 0, where dot(ball.xyz, p) + ball.w = 0; no number
// chooses them.
static inline bool is_plane(__global const PhotonTarget* target) { return target->weight < 0.0f; }

static inline u32 choose_ball(const Scene* scene, u32 targets, float u) {
  u32 ball = 1u;
  while (ball + 1u < targets && scene->photon_targets[ball + 1u].before <= u) ++ball;
  return ball;
}

// 1 minus the cosine of half the angle of the cone to a ball; 2, all directions, from within.
static inline float cone_span(float4 ball, float3 p) {
  const float3 way = ball.xyz - p;
  const float sine2 = ball.w * ball.w / fmax(dot(way, way), 1e-30f);
  return sine2 < 1.0f ? sine2 / (1.0f + sqrt(1.0f - sine2)) : 2.0f;
}

// The density, per steradian, with which photons leave p in the direction d.
static inline float pdf_to_balls(const Scene* scene, u32 targets, float3 p, float3 d) {
  float pdf = 0.0f;
  for (u32 i = 1; i < targets && !is_plane(scene->photon_targets + i); ++i) {
    const float4 ball = scene->photon_targets[i].ball;
    const float span = cone_span(ball, p);
    const float3 way = ball.xyz - p, chord = d - way * rsqrt(fmax(dot(way, way), 1e-30f));
    // The square of the chord is 2 - 2 cos.
    if (span >= 2.0f || 0.5f * dot(chord, chord) <= span)
      pdf += scene->photon_targets[i].weight / (2.0f * M_PI_F * span);
  }
  return pdf;
}

static inline float3 direction_to_ball(float4 ball, float3 p, float a, float b) {
  const float3 way = ball.xyz - p, axis = way * rsqrt(fmax(dot(way, way), 1e-30f));
  const float down = a * cone_span(ball, p);
  return direction_beside(axis, down, sqrt(fmax(down * (2.0f - down), 0.0f)), b);
}

// For parallel light along d: the density per area across it, and a place before everything.
static inline float pdf_across(const Scene* scene, u32 targets, float3 p, float3 d) {
  float pdf = 0.0f;
  for (u32 i = 1; i < targets && !is_plane(scene->photon_targets + i); ++i) {
    const float4 ball = scene->photon_targets[i].ball;
    const float3 way = p - ball.xyz, across = way - dot(way, d) * d;
    if (dot(across, across) <= ball.w * ball.w)
      pdf += scene->photon_targets[i].weight / (M_PI_F * ball.w * ball.w);
  }
  return pdf;
}

static inline float3 place_across(const Scene* scene, float4 ball, float3 d, float a, float b) {
  const float4 all = scene->photon_targets[0].ball;
  const float r = ball.w * sqrt(a);
  float3 s, t;
  axes_about(d, &s, &t);
  const float3 p = ball.xyz + r * (cospi(2.0f * b) * s + sinpi(2.0f * b) * t);
  return p - (dot(p - all.xyz, d) + 1.01f * all.w + ball.w) * d;
}

// How far before p light along d meets the first of the planes that stand in its way: they have no end, and
// the ball about everything leaves them out.
static inline float way_to_planes(const Scene* scene, u32 targets, float3 p, float3 d) {
  float way = 0.0f;
  for (u32 i = targets - 1u; i > 0u && is_plane(scene->photon_targets + i); --i) {
    const float4 plane = scene->photon_targets[i].ball;
    const float to_plane = (dot(plane.xyz, p) + plane.w) / dot(plane.xyz, d);
    if (to_plane < INFINITY) way = fmax(way, to_plane);
  }
  return way;
}

// From afar.
static inline void start_from_afar(const Scene* scene, u32 targets, float4 ball, const Emission* from,
                                   const PhotonNumbers* u, PhotonStart* start) {
  start->d = from->d;
  start->o = place_across(scene, ball, start->d, u->a, u->b);
  start->flux = from->radiance / pdf_across(scene, targets, start->o, start->d);
  start->o -= 1.001f * way_to_planes(scene, targets, start->o, start->d) * start->d;
}

// From a place on a light with an extent, whose sides are at most `side` long.
static inline void start_on_light(const Scene* scene, u32 targets, float4 ball, const Emission* from,
                                  float side, const PhotonNumbers* u, PhotonStart* start) {
  start->d = direction_to_ball(ball, from->p, u->a, u->b);
  start->flux = from->radiance * (fmax(dot(from->n, start->d), 0.0f) * from->area /
                                  pdf_to_balls(scene, targets, from->p, start->d));
  const float3 size = fabs(from->p);
  start->o = from->p + from->n * (OFF_LIGHT * fmax(fmax(size.x, size.y), fmax(size.z, side)));
}

// From a light at a point: the flux of all directions.
static inline void start_at_point(const Scene* scene, u32 targets, float4 ball, const Emission* from,
                                  const PhotonNumbers* u, PhotonStart* start) {
  start->o = from->p;
  start->d = direction_to_ball(ball, start->o, u->a, u->b);
  start->flux = (float3)(1.0f / pdf_to_balls(scene, targets, start->o, start->d));
  start->dimmed = (int)start->light;
}

// A photon of the environment, in lane `lane` of the ways to it.
static inline Emission emit_environment(const LightSamples* sky, u32 lane) {
  const Emission emission = {
      .d = -get3(&sky->wi, lane),
      .radiance = get3(&sky->radiance, lane) / fmax(REAL_LANE(sky->pdf, lane), 1e-30f)};
  return emission;
}

// `sky`: the way to the environment of the photon's lane `lane`, where its light is that.
static inline PhotonStart start_photon(const Scene* scene, u32 targets, const PhotonNumbers* u,
                                       const LightSamples* sky, u32 lane) {
  float share;
  PhotonStart start;
  start.light = choose_photon_light(scene, u->light, &share);
  start.dimmed = NOT_DIMMED;
  const float4 ball = scene->photon_targets[choose_ball(scene, targets, u->ball)].ball;
  __global const Light* light = scene->lights + start.light;
  const bool distant = HAS_ENVIRONMENT && light->kind == LIGHT_ENVIRONMENT;
  const Emission from = distant ? emit_environment(sky, lane) : emit_light(light, u->c, u->e);
  if (!has_place(light))
    start_from_afar(scene, targets, ball, &from, u, &start);
  else if (HAS_AREA_LIGHTS && has_extent(light))
    start_on_light(scene, targets, ball, &from, light->edge_u.w, u, &start);
  else
    start_at_point(scene, targets, ball, &from, u, &start);
  start.flux /= share;
  return start;
}

// The lanes of `lanes` whose numbers choose the environment: general kernels draw scenes without one, whose
// tables are empty.
static inline MASK lanes_of_sky(const Scene* scene, REAL u, MASK lanes) {
  MASK of_sky = NO_LANES;
  EACH_LANE(i, lanes) {
    float share;
    const u32 light = choose_photon_light(scene, REAL_LANE(u, i), &share);
    MASK_LANE(of_sky, i) = scene->lights[light].kind == LIGHT_ENVIRONMENT ? -1 : 0;
  }
  return of_sky;
}

// The photons of `lanes`.
NEVER_INLINE PhotonStarts start_photons(const Scene* scene, const PhotonLaunch* launch, const LaneSamples* at,
                                        MASK lanes) {
  const FourNumbers u = sample_lanes(at, (MASK)((int)DIMENSION_PIXEL)),
                    v = sample_lanes(at, (MASK)((int)DIMENSION_TIME));
  PhotonStarts starts;
  starts.o = all3((float3)(0.0f));
  starts.time = v.x;
  starts.d = all3((float3)(0.0f, 0.0f, 1.0f));
  starts.flux = all3((float3)(0.0f));
  starts.dimmed = (MASK)(NOT_DIMMED);
  starts.light = NO_LANES;
  LightSamples sky CLEARED_ON_GPUS;
  const MASK of_sky = HAS_ENVIRONMENT ? lanes_of_sky(scene, u.w, lanes) : NO_LANES;
  if (any_lane(of_sky)) sky = sample_environment(scene, v.z, v.w, of_sky);
  EACH_LANE(i, lanes) {
    const PhotonNumbers mine = {REAL_LANE(u.w, i), REAL_LANE(u.z, i), REAL_LANE(u.x, i),
                                REAL_LANE(u.y, i), REAL_LANE(v.z, i), REAL_LANE(v.w, i)};
    const PhotonStart start = start_photon(scene, launch->targets, &mine, &sky, i);
    set3(&starts.o, i, start.o);
    set3(&starts.d, i, start.d);
    set3(&starts.flux, i, start.flux);
    MASK_LANE(starts.light, i) = (int)start.light;
    MASK_LANE(starts.dimmed, i) = start.dimmed;
  }
  starts.flux = scale3(starts.flux, 1.0f / (float)launch->count);
  starts.lanes = lanes & MASK_OF(greatest3(starts.flux) > 0.0f) & MASK_OF(greatest3(starts.flux) < INFINITY);
  return starts;
}
