// Hand-written surfaces, as plain text sees them.
#include "plain/path/media.cl"
#include "shared/layers.h"
#include "shared/lobe_energy.h"
#include "shared/lobes.h"
#include "shared/textures.h"

typedef struct LANES(Coordinates) {
  float u, v, length;
  float3 dpdu, dpdv;
} SurfaceCoordinates;
typedef struct LANES(SurfaceInteractions) {
  float3 p, ng, ns, side, color;
  float offset, lift;
  int instance, material, flags;
  bool entering;
  SurfaceCoordinates at;   // HAS_UV
  int prim;                // HAS_MAPS
  float b, c, footprint;   // HAS_MAPS
  float camera_footprint;  // HAS_CHECKER
  float even;              // HAS_RELIEF
  float3 shift;            // HAS_PARALLAX
} SurfaceInteraction;

// Places on objects.
float3 points_of(UNIFORM const Scene* scene, UNIFORM u32 index, const SurfaceInteraction* s, float3 p);
float3 vectors_of(UNIFORM const Scene* scene, UNIFORM u32 index, const SurfaceInteraction* s, float3 a);
float time_of(const SurfaceInteraction* s);
float moved_size(UNIFORM const Scene* scene, UNIFORM u32 index, float time);

// Metal-rough materials.
float metal_mirror(float metalness, float roughness);
float rough_exponent(float roughness);
float highlight_energy(float e);
float metal_highlight(float energy, float mirror);

// Interfaces.
float refracted_cosine(float cos_i, float eta);
float fresnel_reflectance(float cos_i, float cos_t, float eta);
float3 reflect_direction(float3 d, float3 n);
float3 refract_direction(float3 d, float3 n, float cos_i, float cos_t, float eta);
