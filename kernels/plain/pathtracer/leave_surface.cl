// How rays leave surfaces. Photons and features of the denoiser use the same functions.
#include "plain/light/ray_to_light.cl"
#include "plain/pathtracer/path_state.cl"

// The path continues in the direction that the surface sampled. `cut_out`: as if no surface were there.
static inline void leave_surface(UNIFORM const Scene* scene, const Encounter* met, const SurfaceShading* at,
                                 const BsdfSample* sample, bool below, bool cut_out, SceneRay* ray) {
  float way;
  SceneRay child = leaving_ray(scene, ray, met, at, sample->wi, below, &way);
  child.t_max = INFINITY;
  if (cut_out) cross_further(ray, &child);
  *ray = child;
}

// The path continues straight behind a surface that the camera does not see.
HAVING(HAS_CATCHERS)
static inline void pass_straight(UNIFORM const Scene* scene, const Encounter* met, const SurfaceShading* at,
                                 SceneRay* ray) {
  float way;
  SceneRay behind = leaving_ray(scene, ray, met, at, ray->d, true, &way);
  behind.t_max = INFINITY;
  cross_further(ray, &behind);
  *ray = behind;
}
