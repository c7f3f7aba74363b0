// Shadow catchers: the camera sees through them, darker by the part of the lamps' light that shadows take.
#include "plain/pathtracer/leave_surface.cl"
#include "plain/pathtracer/next_event.cl"

#define CATCHER_LIGHTS 8

// The part of the lamps' light that arrives at a matte surface, by one shadow ray. Its lamp is one of several
// that are chosen as paths choose theirs, by the light that it sends without shadows (resampled importance
// sampling: Talbot, Cline and Egbert 2005), since a mean over lamps of what each shadow takes is wanted.
HAVING(HAS_CATCHERS)
static float part_arriving(UNIFORM const Scene* scene, const PathState* path, const SceneRay* ray,
                           const Encounter* met, const SurfaceShading* at, UNIFORM u32* counts) {
  const Numbers u = numbers_at(&path->at, dimension_here(path->depth, BOUNCE_LIGHT_POINT), true, true);
  const Numbers chance = numbers_at(&path->at, dimension_here(path->depth, BOUNCE_DIRECTION), true, true);
  float sum = 0.0f, turn = chance.z;
  LightSample kept;
  kept.wi = (float3)(0.0f);
  kept.radiance = (float3)(0.0f);
  kept.distance = 0.0f;
  kept.pdf = 0.0f;
  kept.delta = false;
  for (int k = 0; k < CATCHER_LIGHTS; ++k) {
    Numbers v;
    v.x = u.x + (float)k * (1.0f / (float)CATCHER_LIGHTS);
    v.x -= floor(v.x);
    v.y = u.y + (float)k * 0.61803399f;
    v.y -= floor(v.y);
    v.z = (u.z + (float)k) * (1.0f / (float)CATCHER_LIGHTS);
    int chosen;
    bool seen;
    const LightSample light = choose_one(scene, at->s.p, &v, &chosen, &seen);
    const float cosine = real_max(dot(at->s.ns, light.wi), 0.0f);
    const float over = light.delta ? M_PI_F : 1.0f;
    float sent = 0.0f;
    if (light.pdf > 0.0f && dot(at->s.side, light.wi) > 0.0f)
      sent = greatest(light.radiance) * cosine * over / light.pdf;
    sum += sent;
    if (sent > 0.0f && turn * sum < sent) {
      kept = light;
      turn = turn * sum / sent;
    } else if (sent > 0.0f) {
      turn = (turn * sum - sent) / (sum - sent);
    }
  }
  if (!(sum > 0.0f && kept.distance > 0.0f)) return 1.0f;
  count(counts, COUNT_SHADOW);
  note_ray(counts);
  SceneRay to_light = ray_to_light(scene, ray, met, at, &kept, false);
  const float3 white = (float3)(1.0f);
  const float3 left = light_arriving(scene, &to_light, white, counts);
  return (left.x + left.y + left.z) * (1.0f / 3.0f);
}

// The path continues straight behind the catcher, with what its shadows leave.
HAVING(HAS_CATCHERS)
static void pass_catcher(UNIFORM const Scene* scene, const Encounter* met, const SurfaceShading* at,
                         PathState* path, SceneRay* ray, UNIFORM u32* counts) {
  if (scene->info->light_count > 0u) path->throughput *= part_arriving(scene, path, ray, met, at, counts);
  pass_straight(scene, met, at, ray);
  note_ray(counts);
}
