// The rays of a tile and what their pixels have received: hand-written, as plain text sees them.
#include "plain/light/field_light.cl"
#include "plain/path/waiting_ray.cl"
#include "plain/shade/leaving_ray.cl"

typedef struct LANES(TileSamples) {
} TileSamples;

// Two random numbers at the surface that the ray meets, for part `part` of `parts`. `dimension`:
// BOUNCE_... of the surface or, with DIMENSIONS_OF_LIGHT(), of a light there.
void bounce_numbers(UNIFORM const TileSamples* tile, const WaitingRay* path, UNIFORM u32 dimension,
                    UNIFORM u32 part, UNIFORM u32 parts, HERE, float* u_x, float* u_y);
int child_branch(int branch, UNIFORM u32 kind);

// The ray waits, if there is room. Counts it as one of `kind`.
bool push_child(UNIFORM const TileSamples* tile, const SceneRay* ray, const WaitingRay* path, HERE,
                UNIFORM u32 kind, UNIFORM u32* counts);

// Puts the ray back on the stack, where rays are taken in batches.
void wait_again(UNIFORM const TileSamples* tile, const SceneRay* ray, const WaitingRay* path, HERE);

// A shadow ray waits.
void push_shadow(UNIFORM const TileSamples* tile, const SceneRay* ray, const WaitingRay* path, HERE);
CALLED(note_rays) void note_pixel_ray(int pixel, HERE, UNIFORM u32* counts);

// Light that a pixel receives.
void add_light(UNIFORM const TileSamples* tile, int pixel, float3 light, HERE);

// A pixel shows `part` less of the background; a surface or a medium covers `part` of its pixel.
void uncover(UNIFORM const TileSamples* tile, int pixel, float part, HERE);
void cover_by(UNIFORM const Scene* scene, UNIFORM const TileSamples* tile, int pixel, int instance,
              int material, HERE, float part);
