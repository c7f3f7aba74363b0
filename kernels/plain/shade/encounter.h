// Rays' next surfaces, as hand-written code finds them.
#include "plain/path/scene_ray.cl"
#include "plain/shade/bsdf.h"

typedef struct LANES(Faces) {
  float3 outward;  // not normalised
  bool entering;   // the ray comes from outside
  int material, flags, medium;
} Face;
typedef struct LANES(Encounters) {
  SurfaceHit hit;
  Face face;
  int before, after;
  float3 absorbed;
} Encounter;
typedef struct LANES(Shading) {
  SurfaceInteraction s;
  Bsdf bsdf;
} SurfaceShading;

bool hit_anything(const SurfaceHit* hit);
float clear_of_fog(UNIFORM const Scene* scene, const Encounter* met, HERE);

// Light on reliefs.
float relief_visibility(UNIFORM const Scene* scene, const SurfaceInteraction* s, float3 wi, HERE);
float walls_visibility(UNIFORM const Scene* scene, const SceneRay* ray, const SurfaceInteraction* s,
                       float3 wi, HERE, UNIFORM u32* counts);

// Rays that leave surfaces.
float3 leave_relief(const SurfaceInteraction* s, float3 wi, float* way);
float3 leaving_normal(const SurfaceInteraction* s);
float3 points_behind(UNIFORM const Scene* scene, const SurfaceInteraction* s, float3 d, HERE);
void enter_behind(const Encounter* met, const SceneRay* ray, HERE, SceneRay* child);
