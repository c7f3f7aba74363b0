// The ray that leaves a surface.
#include "plain/shade/meet_interfaces.cl"

// It goes in the direction d, above the surface or `below`, behind it. `way`: how far its start is from where
// the relief lets it go.
static inline SceneRay leaving_ray(UNIFORM const Scene* scene, const SceneRay* ray, const Encounter* met,
                                   const SurfaceShading* at, float3 d, bool below, float* way) {
  const SurfaceInteraction* s = &at->s;
  SceneRay child = *ray;
  start_on_surfaces(scene->info, &child, &met->hit, !s->entering);
  child.d = d;
  child.t_min = 0.0f;
  child.o = along(leave_relief(s, d, way), s->offset + s->lift, leaving_normal(s));
  if (below) {
    child.o = point_behind(scene, s, ray->d);
    start_on_hits(scene->info, &child, &met->hit, s->entering);
    enter_behind(met, &child);
  }
  return child;
}
