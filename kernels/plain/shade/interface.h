// Hand-written surfaces, as plain text sees them.
#include "plain/path/directions.cl"
#include "plain/path/face.cl"
#include "plain/path/media.cl"
#include "plain/path/optics.cl"
#include "shared/bvh.h"
#include "shared/layers.h"
#include "shared/lobe_energy.h"
#include "shared/lobes.h"
#include "shared/textures.h"
#define LOWERED float
#include "plain/shade/lowering.h"

// Objects: between their own space and the world, and moved in time.
float3 object_points(UNIFORM __global const Instance* instance, float3 p);
float3 object_vectors(UNIFORM __global const Instance* instance, float3 a);
float3 still_points(UNIFORM const Scene* scene, UNIFORM u32 index, float3 p, float time);
float3 still_vectors(UNIFORM const Scene* scene, UNIFORM u32 index, float3 a, float time);
float3 moved_vectors(UNIFORM const Scene* scene, UNIFORM u32 index, float3 a, float time);
UNIFORM float moved_extent(UNIFORM const Scene* scene, UNIFORM u32 index);
float moved_size(UNIFORM const Scene* scene, UNIFORM u32 index, float time);

// Hits.
typedef struct LANES(SurfacePoints) {
  float u, v;
  float3 dpdu, dpdv;
} SolidPoint;
void points_on_solid(UNIFORM const Scene* scene, UNIFORM u32 shape, UNIFORM float4 parameters, float3 p,
                     int part, HERE, SolidPoint* at);
float solid_curvatures(UNIFORM const Scene* scene, UNIFORM u32 shape, UNIFORM float4 parameters, float3 p,
                       int part, HERE);
float3 still_origins(const SurfaceHit* hit, UNIFORM u32 index, float3 o);
float3 still_directions(const SurfaceHit* hit, UNIFORM u32 index, float3 d);
float3 field_points(UNIFORM __global const Instance* instance, float3 p);
float3 sdf_color(UNIFORM const Scene* scene, UNIFORM u32 index, float3 p);

typedef struct Parametrization {
  float u, v;
  float3 dpdu, dpdv;
  float length;  // world length of a unit of u and v (geometric mean); 0: unknown
} Parametrization;

typedef struct SurfaceInteraction {
  float3 p;                              // world
  float3 ng, ns;                         // unit, both against the ray
  float3 side;                           // likewise: what is above, by it, is before the surface
  float offset;                          // distance off the surface at which secondary rays start
  float lift;                            // how far the surface that smooth normals mean is before it
  float3 color;                          // vertex or field colour, a factor on ambient and diffuse
  int instance;                          // index
  int material, flags;                   // index; of the material
  int medium;                            // inside the surface
  bool entering;                         // the ray comes from outside
  HAVING(HAS_OBJECT_MOTION) float time;  // of the ray
  HAVING(HAS_UV) Parametrization at;
  HAVING(HAS_MAPS) int prim;  // the hit's, like b and c, its u and v
  HAVING(HAS_MAPS) float b, c;
  HAVING(HAS_MAPS) float footprint;            // width of the ray's footprint on the surface, in the world
  HAVING(HAS_CHECKER) float camera_footprint;  // footprint of a camera ray of this length
  HAVING(HAS_RELIEF) bool bent;                // ns differs from the geometry's normal
  HAVING(HAS_RELIEF) float even;  // length of the normal map's mean normal in the footprint, 1 if uniform
  HAVING(HAS_PARALLAX)
  float3 shift;                      // along the surface to where the ray hits the relief below it, whose
                                     // are u and v
  HAVING(HAS_PARALLAX) float sunk;   // depth of that point relative to the relief's
  HAVING(HAS_PARALLAX) float below;  // depth below another surface in whose relief this one lies, or 0
  HAVING(HAS_PARALLAX) float3 top;   // that surface's normal
} SurfaceInteraction;
