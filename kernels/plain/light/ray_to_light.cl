// The shadow ray from a surface to a place on a light.
#include "plain/light/light_sample.cl"
#include "plain/shade/leaving_ray.cl"

// Where the surface's lift moves the start, the ray aims at the place from there: with the direction and
// distance from the surface it would meet the lamp, which would then shadow itself.
static inline SceneRay ray_to_light(UNIFORM const Scene* scene, const SceneRay* ray, const Encounter* met,
                                    const SurfaceShading* at, const LightSample* light, bool below) {
  float way;
  SceneRay to_light = leaving_ray(scene, ray, met, at, light->wi, below, &way);
  to_light.t_max = below ? light->distance : light->distance - way;
  if (HAS_MESH && !below && at->s.lift > 0.0f && light->distance < INFINITY) {
    const float3 to = along(at->s.p - to_light.o, light->distance, light->wi);
    to_light.d = safe_unit3(to);
    to_light.t_max = dot(to, to_light.d);
  }
  return to_light;
}
