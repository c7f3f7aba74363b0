// How photons leave the lights: towards the balls about what mirrors and bends light. A photon's density is
// that of all balls together, so that one that might have been sent to several counts for each (the balance
// heuristic of Veach and Guibas 1995 with one sample).
#include "plain/light/light.cl"

#define NOT_DIMMED (-1)
#define OFF_LIGHT 0x1p-17f  // how far photons start off a light's surface, of its place's greatest coordinate

typedef struct PhotonStart {
  float3 o, d;
  float3 flux;  // for one photon; a placed delta light's lacks the factor of dim_with_distance()
  float time;   // of moving objects, from 0 to 1
  int light;    // index of the one that it comes from
  int dimmed;   // the light whose distance counts where the photon is first bent, or NOT_DIMMED
} PhotonStart;

// The light by the number u, and its share.
static inline u32 choose_photon_light(UNIFORM const Scene* scene, float u, float* share) {
  __global const float* sums = scene->photon_lights;
  u32 low = 0u, high = scene->info->table_lights - 1u;
  while (low < high) {
    const u32 middle = (low + high) / 2u;
    if (sums[middle] <= u)
      low = middle + 1u;
    else
      high = middle;
  }
  *share = sums[low];
  if (low != 0u) *share -= sums[low - 1u];
  return low;
}

// Planes follow the balls in the table, with a weight below 0, where dot(ball.xyz, p) + ball.w = 0; no number
// chooses them.
static inline bool is_plane(UNIFORM __global const PhotonTarget* target) { return target->weight < 0.0f; }

static inline u32 choose_ball(UNIFORM const Scene* scene, UNIFORM u32 targets, float u) {
  u32 ball = 1u;
  for (u32 i = 2u; i < targets && !is_plane(scene->photon_targets + i); ++i)
    if (scene->photon_targets[i].before <= u) ball = i;
  return ball;
}

// 1 minus the cosine of half the angle of the cone to a ball; 2, all directions, from within.
static inline float cone_span(float4 ball, float3 p) {
  const float3 way = ball.xyz - p;
  const float sine2 = ball.w * ball.w / fmax(plain_dot(way, way), 1e-30f);
  return sine2 < 1.0f ? sine2 / (1.0f + sqrt(1.0f - sine2)) : 2.0f;
}

// The unit vector from p to the middle of a ball.
static inline float3 towards_ball(float4 ball, float3 p) {
  const float3 way = ball.xyz - p;
  return way * rsqrt(fmax(plain_dot(way, way), 1e-30f));
}

// The density, per steradian, with which photons leave p in the direction d.
static inline float pdf_to_balls(UNIFORM const Scene* scene, UNIFORM u32 targets, float3 p, float3 d) {
  float pdf = 0.0f;
  for (u32 i = 1u; i < targets && !is_plane(scene->photon_targets + i); ++i) {
    const float4 ball = scene->photon_targets[i].ball;
    const float span = cone_span(ball, p);
    const float3 chord = d - towards_ball(ball, p);
    // The square of the chord is 2 - 2 cos.
    if (span >= 2.0f || 0.5f * plain_dot(chord, chord) <= span)
      pdf += scene->photon_targets[i].weight / (2.0f * M_PI_F * span);
  }
  return pdf;
}

static inline float3 direction_to_ball(float4 ball, float3 p, float a, float b) {
  const float down = a * cone_span(ball, p);
  return direction_beside(towards_ball(ball, p), down, sqrt(fmax(down * (2.0f - down), 0.0f)), b);
}

// For parallel light along d: the density per area across it, and a place before everything.
static inline float pdf_across(UNIFORM const Scene* scene, UNIFORM u32 targets, float3 p, float3 d) {
  float pdf = 0.0f;
  for (u32 i = 1u; i < targets && !is_plane(scene->photon_targets + i); ++i) {
    const float4 ball = scene->photon_targets[i].ball;
    const float3 way = p - ball.xyz, across = way - plain_dot(way, d) * d;
    if (plain_dot(across, across) <= ball.w * ball.w)
      pdf += scene->photon_targets[i].weight / (M_PI_F * ball.w * ball.w);
  }
  return pdf;
}

static inline float3 place_across(UNIFORM const Scene* scene, float4 ball, float3 d, float a, float b) {
  const float4 all = scene->photon_targets[0].ball;
  const float3 p = ball.xyz + ball.w * sqrt(a) * across_axis(d, b);
  return p - (plain_dot(p - all.xyz, d) + 1.01f * all.w + ball.w) * d;
}

// How far before p light along d meets the first of the planes that stand in its way: they have no end, and
// the ball about everything leaves them out.
static inline float way_to_planes(UNIFORM const Scene* scene, UNIFORM u32 targets, float3 p, float3 d) {
  float way = 0.0f;
  for (u32 i = targets - 1u; i > 0u && is_plane(scene->photon_targets + i); --i) {
    const float4 plane = scene->photon_targets[i].ball;
    const float to_plane = (plain_dot(plane.xyz, p) + plane.w) / plain_dot(plane.xyz, d);
    if (to_plane < INFINITY) way = fmax(way, to_plane);
  }
  return way;
}

// A photon of the environment, in the direction of a way to it.
ENTRY static inline Emission emit_environment(const LightSample* sky) {
  return emit_along(-sky->wi, sky->radiance / fmax(sky->pdf, 1e-30f));
}

// The photon of a light, to a ball, a place in which `u` chooses; `v` chooses one on the light.
static inline void start_from(UNIFORM const Scene* scene, UNIFORM u32 index, UNIFORM u32 targets, float4 ball,
                              const Numbers* u, const Numbers* v, PhotonStart* start) {
  __global const Light* light = scene->lights + index;
  Emission from;
  if (HAS_ENVIRONMENT && light->kind == LIGHT_ENVIRONMENT) {
    const LightSample sky = sample_environment(scene, v->z, v->w);
    from = emit_environment(&sky);
  } else
    from = emit_light(light, v->z, v->w);
  start->o = from.p;
  start->d = from.d;
  if (!has_place(light)) {
    start->o = place_across(scene, ball, from.d, u->x, u->y);
    float3 arriving = from.radiance;
    if (HAS_ABSORPTION) {  // the world's medium has no end
      const float3 lost = scene->media[0].absorption.xyz;
      if (lost.x != 0.0f) arriving.x = 0.0f;
      if (lost.y != 0.0f) arriving.y = 0.0f;
      if (lost.z != 0.0f) arriving.z = 0.0f;
    }
    start->flux = arriving / pdf_across(scene, targets, start->o, from.d);
    start->o -= 1.001f * way_to_planes(scene, targets, start->o, from.d) * from.d;
    return;
  }
  start->d = direction_to_ball(ball, from.p, u->x, u->y);
  const float pdf = pdf_to_balls(scene, targets, from.p, start->d);
  if (HAS_AREA_LIGHTS && has_extent(light)) {
    start->flux = from.radiance * (fmax(plain_dot(from.n, start->d), 0.0f) * from.area / pdf);
    const float size = real_max(greatest_size(from.p), light->edge_u.w);
    start->o += from.n * (OFF_LIGHT * size);
  } else {  // the flux of all directions
    start->flux = (float3)(1.0f / pdf);
    start->dimmed = (int)index;
  }
}

// The photon of these numbers, one of `count`. Returns whether it carries light.
ENTRY static bool start_photon(UNIFORM const Scene* scene, UNIFORM u32 targets, UNIFORM u32 count,
                               const SampleAt* at, OUT PhotonStart* start) {
  const Numbers u = numbers_at(at, (int)DIMENSION_PIXEL, true, true);
  const Numbers v = numbers_at(at, (int)DIMENSION_TIME, true, true);
  float share;
  const u32 chosen = choose_photon_light(scene, u.w, &share);
  const u32 target = choose_ball(scene, targets, u.z);
  const float4 ball = scene->photon_targets[target].ball;
  PhotonStart photon = {(float3)(0.0f), (float3)(0.0f, 0.0f, 1.0f), (float3)(0.0f), v.x, (int)chosen,
                        NOT_DIMMED};
  EACH_ALIKE(u32, index, chosen) start_from(scene, index, targets, ball, &u, &v, &photon);
  photon.flux = photon.flux / share * (1.0f / (float)count);
  *start = photon;
  return greatest(photon.flux) > 0.0f && greatest(photon.flux) < INFINITY;
}
