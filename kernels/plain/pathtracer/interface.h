// Hand-written structs and functions that the plain path tracer uses; structs with the members that it reads
// or sets.
#include "plain/core.h"
#include "plain/light/shadow.cl"
#include "plain/light/sky.cl"
#include "plain/shade/lobes.cl"

typedef struct LANES(PhotonSearches) {
  float area;
} PhotonSearch;

CALLED(no_hits) SurfaceHit hit_nothing(float t_max);

// Photons about a surface, one after the other.
PhotonSearch search_photons(UNIFORM const Scene* scene, const SampleAt* at, int depth, const SceneRay* ray,
                            const SurfaceInteraction* s, HERE);
bool next_photon(UNIFORM const Scene* scene, PhotonSearch* search, HERE, float3* wi, float3* flux);

// The map of photons that a sample looks at, and their slice of time.
CONSTANT u32 PHOTON_SLICES;
UNIFORM __global const PhotonMap* map_of_sample(UNIFORM const Scene* scene, UNIFORM u32 sample);
CALLED(photon_slices_of) int photon_slice_of(const SceneRay* ray);
