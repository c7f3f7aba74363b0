// Hand-written structs and functions that the plain path tracer uses; structs with the members that it reads
// or sets.
#include "plain/core.h"
#include "plain/light/sky.cl"
#include "plain/shade/encounter.h"
#include "plain/shade/lobes.cl"

typedef struct LANES(PhotonSearches) {
  float area;
} PhotonSearch;

// The way to the next interface.
bool meet_interfaces(UNIFORM const Scene* scene, SceneRay* ray, HERE, UNIFORM bool coherent, Encounter* met,
                     UNIFORM u32* counts);
bool pass_hidden(UNIFORM const Scene* scene, SceneRay* ray, const Encounter* met, HERE);
CALLED(no_hits) SurfaceHit hit_nothing(float t_max);

// Lights.
int choose_lights(UNIFORM const Scene* scene, float3 p, float u, HERE, float* probability);
float light_probabilities(UNIFORM const Scene* scene, UNIFORM u32 leaf, float3 p, HERE);
float3 light_arriving(UNIFORM const Scene* scene, SceneRay* ray, float3 light, HERE, UNIFORM u32* counts);

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
