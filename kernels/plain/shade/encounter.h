// Rays' next surfaces, as hand-written code finds them.
#include "plain/path/segment.cl"
#include "plain/shade/bsdf.h"

typedef struct LANES(Shading) {
  SurfaceInteraction s;
  Bsdf bsdf;
} SurfaceShading;

// Light on reliefs.
float relief_visibility(UNIFORM const Scene* scene, const SurfaceInteraction* s, float3 wi, HERE);
float walls_visibility(UNIFORM const Scene* scene, const SceneRay* ray, const SurfaceInteraction* s,
                       float3 wi, HERE, UNIFORM u32* counts);

// Rays that leave surfaces.
float3 leave_relief(const SurfaceInteraction* s, float3 wi, float* way);
float3 leaving_normal(const SurfaceInteraction* s);
float3 points_behind(UNIFORM const Scene* scene, const SurfaceInteraction* s, float3 d, HERE);
