// Hand-written structs and functions that the plain path tracer uses; structs with the members that it reads
// or sets.
#include "plain/core.h"
#include "plain/light/sky.cl"
#include "plain/path/scene_ray.cl"
#include "plain/shade/lobes.cl"

typedef struct LANES(Faces) {
  int flags;
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
typedef struct LANES(PhotonSearches) {
  float area;
} PhotonSearch;

// The way to the next interface.
bool meet_interfaces(UNIFORM const Scene* scene, SceneRay* ray, HERE, UNIFORM bool coherent, Encounter* met,
                     UNIFORM u32* counts);
bool pass_hidden(UNIFORM const Scene* scene, SceneRay* ray, const Encounter* met, HERE);
CALLED(no_hits) SurfaceHit hit_nothing(float t_max);
bool hit_anything(const SurfaceHit* hit);

// Lights.
int choose_lights(UNIFORM const Scene* scene, float3 p, float u, HERE, float* probability);
float light_probabilities(UNIFORM const Scene* scene, UNIFORM u32 leaf, float3 p, HERE);
float3 light_arriving(UNIFORM const Scene* scene, SceneRay* ray, float3 light, HERE, UNIFORM u32* counts);
float clear_of_fog(UNIFORM const Scene* scene, const Encounter* met, HERE);

// Surfaces.
void shade_hits(UNIFORM const Scene* scene, const SceneRay* ray, const Encounter* met, HERE,
                SurfaceShading* at);
float terminator(const SurfaceInteraction* s, float3 wi);
float relief_visibility(UNIFORM const Scene* scene, const SurfaceInteraction* s, float3 wi, HERE);
float walls_visibility(UNIFORM const Scene* scene, const SceneRay* ray, const SurfaceInteraction* s,
                       float3 wi, HERE, UNIFORM u32* counts);

// Wavelengths at surfaces.
bool disperses(UNIFORM const Scene* scene, int before, int after, HERE);

// Photons about a surface, one after the other.
PhotonSearch search_photons(UNIFORM const Scene* scene, const SampleAt* at, int depth, const SceneRay* ray,
                            const SurfaceInteraction* s, HERE);
bool next_photon(UNIFORM const Scene* scene, PhotonSearch* search, HERE, float3* wi, float3* flux);

// The map of photons that a sample looks at, and their slice of time.
CONSTANT u32 PHOTON_SLICES;
UNIFORM __global const PhotonMap* map_of_sample(UNIFORM const Scene* scene, UNIFORM u32 sample);
CALLED(photon_slices_of) int photon_slice_of(const SceneRay* ray);

// Rays that leave surfaces.
float3 leave_relief(const SurfaceInteraction* s, float3 wi, float* way);
float3 leaving_normal(const SurfaceInteraction* s);
float3 points_behind(UNIFORM const Scene* scene, const SurfaceInteraction* s, float3 d, HERE);
void enter_behind(const Encounter* met, const SceneRay* ray, HERE, SceneRay* child);
