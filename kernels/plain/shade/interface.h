// Hand-written surfaces, as plain text sees them.
#include "plain/path/media.cl"
#include "shared/layers.h"
#include "shared/lobe_energy.h"
#include "shared/lobes.h"
#include "shared/textures.h"

typedef struct LANES(Coordinates) {
  float3 dpdu;
} SurfaceCoordinates;
typedef struct LANES(SurfaceInteractions) {
  float3 p, ng, ns, side, color;
  float offset, lift;
  int instance, material, flags;
  bool entering;
  SurfaceCoordinates at;   // HAS_UV
  float camera_footprint;  // HAS_CHECKER
  float even;              // HAS_RELIEF
} SurfaceInteraction;

// Places on objects, and textures.
typedef struct LANES(TexturePoints) {
  float footprint;
} TexturePoint;
typedef struct LANES(SlotValues) {
  float4 of[20];  // by MAP_*
} SlotValues;
float3 points_of(UNIFORM const Scene* scene, UNIFORM u32 index, const SurfaceInteraction* s, float3 p);
float3 vectors_of(UNIFORM const Scene* scene, UNIFORM u32 index, const SurfaceInteraction* s, float3 a);
float time_of(const SurfaceInteraction* s);
float moved_size(UNIFORM const Scene* scene, UNIFORM u32 index, float time);
float checker_pattern(float3 q, float3 w);
float3 sines_to_axes(float3 n);
void texture_points(UNIFORM const Scene* scene, const SurfaceInteraction* s, HERE, TexturePoint* at);
UNIFORM bool has_slot(UNIFORM __global const MaterialMaps* maps, UNIFORM u32 slot);
void read_slots(UNIFORM const Scene* scene, UNIFORM __global const MaterialMaps* maps, UNIFORM u32 wanted,
                const TexturePoint* at, HERE, SlotValues* values);
float metal_mirror(float metalness, float roughness);
float rough_exponent(float roughness);
float highlight_energy(float e);
float metal_highlight(float energy, float mirror);

// Interfaces.
float refracted_cosine(float cos_i, float eta);
float fresnel_reflectance(float cos_i, float cos_t, float eta);
float3 reflect_direction(float3 d, float3 n);
float3 refract_direction(float3 d, float3 n, float cos_i, float cos_t, float eta);

// Facets.
float lobe_energy_at(UNIFORM const Scene* scene, UNIFORM u32 first, float c, float alpha, HERE);
float glass_value(UNIFORM const Scene* scene, float eta, float c, float alpha, HERE);
float glass_row(UNIFORM const Scene* scene, UNIFORM u32 first, UNIFORM u32 rows, float thick, float alpha,
                HERE);
