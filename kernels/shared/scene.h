// Materials, media, the camera and the frame: tables for shading. Colours are linear RGB.
#pragma once
#include "shared/lights.h"
#include "shared/types.h"
SUNDOG_SHARED_BEGIN

#define MATERIAL_PHONG 0u       // local terms and constant kr, kt
#define MATERIAL_DIELECTRIC 1u  // kr, kt from the Fresnel equations; nonzero local terms are added

#define MATERIAL_BLINN 1u          // Blinn's half vector instead of Phong's reflected ray
#define MATERIAL_SHADOW_OPAQUE 2u  // blocks shadow rays even if it transmits
#define MATERIAL_CHECKER 4u        // ambient and diffuse alternate with checker_ambient and checker_diffuse
#define MATERIAL_TRANSMITS 8u      // kt or Fresnel transmission is not zero
#define MATERIAL_REFLECTS 16u
#define MATERIAL_THIN 32u          // no interior: transmits straight through and does not change the medium
#define MATERIAL_VERTEX_COLOR 64u  // ambient and diffuse are multiplied by the vertex colour
#define MATERIAL_CLEAR 128u        // no local terms or tint: invisible between equal indices
#define MATERIAL_METAL_ROUGH 256u  // terms follow from metalness and roughness (plain/shade/lowering.h)
#define MATERIAL_ONE_SIDED 512u    // invisible from behind
#define MATERIAL_LAYERED 1024u     // has layers (shared/layers.h)
#define MATERIAL_SCATTERS_ONCE 2048u  // no multiple scattering between its facets
#define MATERIAL_SHINES 4096u         // has a highlight: `specular` is not black
#define MATERIAL_EMITS 8192u          // `emission` is not black
#define MATERIAL_FROSTED 16384u       // path: thin with transmitting facets
#define MATERIAL_WALL 32768u          // thin, with an index: transmission.w
#define MATERIAL_OFF_CAMERA 65536u    // a lamp invisible to camera rays
#define MATERIAL_CATCHER 131072u      // path: the camera sees its shadows alone
#define MATERIAL_ROUGH 262144u        // reflects or transmits by facets
#define MATERIAL_GROUP_SHIFT 20u      // above: the group of lights that its emission belongs to

// Facets with a smaller alpha are treated as smooth by paths.
#define LEAST_ALPHA 1e-4f

// Integer exponents up to this one are computed by multiplication.
#define GREATEST_WHOLE_EXPONENT 65535.0f

#define LOBE_STEPS 32u                        // of each table in lobe_energy, along each axis
#define LOBE_GAINS (LOBE_STEPS * LOBE_STEPS)  // offset of the second table
#define LOBE_GLASS (2u * LOBE_GAINS)          // offset of the table of dielectrics
#define GLASS_STEPS 20u                       // of that table, along alpha and the cosine
#define GLASS_INDICES 16u                     // along the square root of 1 - 1 / eta, from 0 to GLASS_REACH
#define GLASS_REACH 0.75f

// 144 bytes. Colours are premultiplied by their coefficients.
typedef struct Material {
  float4 ambient;          // ka
  float4 diffuse;          // kd
  float4 specular;         // ks; w = exponent
  float4 reflection;       // kr (tint of a dielectric, normally 1); w = alpha of rough lobes
  float4 transmission;     // kt (tint of a dielectric, normally 1); w = index of a thin wall
  float4 checker_ambient;  // ka in odd cells
  float4 checker_diffuse;  // kd in odd cells; w = 1 / cell size (object space)
  float4 emission;         // radiance emitted to the outside
  u32 kind;                // MATERIAL_PHONG, MATERIAL_DIELECTRIC
  u32 flags;
  u32 medium;  // index of the interior medium
  u32 maps;    // index of its MaterialMaps; 0: none
} Material;
SUNDOG_SHARED_SIZE(Material, 144)

#define MAX_MEDIA 255  // a ray's stack of media stores indices as bytes

// 48 bytes. Medium 0 is the world's.
typedef struct Medium {
  float4 absorption;  // extinction per unit of world length; w = refractive index
  float4 scattering;  // scattering per unit of world length; w = mean cosine
  i32 priority;       // the highest wins in an overlap; among equals, the last entered (Schmidt, Budge 2002)
  u32 spectrum;       // path: offset of its indices in the table `spectra`; NO_SPECTRUM: absorption.w
  u32 pad0, pad1;
} Medium;
SUNDOG_SHARED_SIZE(Medium, 48)

// How path tracing finds light: by both strategies, weighted by MIS; by sampling lights alone, if they can be
// sampled; or by scattered rays alone, if they can hit lights.
#define LIGHT_STRATEGIES(STRATEGY)  \
  STRATEGY(STRATEGY_MIS, mis)       \
  STRATEGY(STRATEGY_LIGHTS, lights) \
  STRATEGY(STRATEGY_SURFACES, surfaces)
#define STRATEGY_MIS 0u
#define STRATEGY_LIGHTS 1u
#define STRATEGY_SURFACES 2u

// Maximum number of shadow rays of a surface that wait on devices with one ray a lane; a surface with more
// lights is met again for the rest.
#define MOST_LIGHT_ROOM 16u

// Maximum number of instances for shaft tests of occlusion, which give one bit each.
#define SHAFT_INSTANCES 32u

// The fraction of SceneInfo.cutoff below which a light gets no ray.
#define LEAST_OF_LIGHT 0x1p-12f

// 400 bytes: the scene's constants. Positions in all tables are relative to the world position `origin` +
// `origin_rest`, near the camera's target (host/compile/view/local_origin.h). Pixel (x, y), y down, with
// sample offset (a, b) in [0, 1)^2 looks along camera_corner + (x + a) camera_dx + (y + b) camera_dy, which
// has length 1 along camera_forward. HAS_ORTHOGRAPHIC: that is the ray's start, from camera_position, and
// camera_corner.w is 1 / the target's distance.
typedef struct SceneInfo {
  float4 camera_position;
  float4 camera_corner;
  float4 camera_dx;
  float4 camera_dy;
  float4 camera_forward;     // unit; w = near clipping depth
  float4 background_bottom;  // w = far clipping depth (may be infinite)
  float4 background_top;  // seen by rays that hit nothing: bottom..top, linear in the sine of the elevation
  float4 ambient;         // sum of the ambient lights
  u32 width, height;
  u32 tlas_root;      // root node of the scene BVH, or BVH_LEAF: instance 0 is its only leaf
  u32 bounded_count;  // instances in the scene BVH (0: it is empty)
  u32 instance_count;
  u32 light_count;  // shadow rays per surface: one per light, or light_rays with HAS_AREA_LIGHTS
  u32 material_count, medium_count;
  u32 max_depth;         // 1: no secondary rays; camera rays have depth 1
  u32 samples;           // per pixel
  float cutoff;          // ends rays whose largest throughput component is below it
  u32 camera_inside;     // 1: the camera may be inside a solid with a medium, so its media must be found
  float4 scene_center;   // bounding sphere of all instances except planes and fields; w = radius
  float4 up;             // unit: the scene's up
  float4 fog;            // colour of the world's fog; w = density per unit of length (0: none)
  u32 field_end;         // instances [instance_count, field_end) place distance fields
  u32 table_lights;      // rows of the light table
  u32 sees_environment;  // SEEN_BY_*: rays that see the environment if they hit nothing, not the background
  u32 texel_page;        // units of TEXEL_UNIT bytes in each of texels0 to texels2
  float4 origin;         // world position of the tables' origin
  float4 origin_rest;    // the remainder of its rounding to floats
  // HAS_LENS: from the lens's centre to its rim, right and up; w = focus depth; blades.
  float4 lens_x, lens_y;
  // HAS_CAMERA_MOTION: translation of these while the shutter is open; w of the first three: of
  // camera_forward, if HAS_ORTHOGRAPHIC.
  float4 moved_position, moved_corner, moved_dx, moved_dy;
  // Path tracing:
  u32 roulette_depth;  // depth at which Russian roulette starts
  u32 light_strategy;  // STRATEGY_*
  u32 guide_count;     // rows of the table `guides`: balls, w = radius
  // Whitted's integrator:
  u32 shafts;           // 1: surfaces ask by shafts what stands before area lights
                        // (plain/whitted/shaft_light.cl)
  u32 seed;             // added to the dimensions of samples, a multiple of four; 0: the default
  u32 transparent;      // 1: what is behind the scene is not seen straight on; alpha says how much
  float max_component;  // of a sample's light: brighter ones are scaled down to it; infinite: none are
  u32 pad0;
} SceneInfo;
SUNDOG_SHARED_SIZE(SceneInfo, 400)

// Ray counters of a launch, added with integer atomics (any order gives the same sum).
#define COUNT_PRIMARY 0
#define COUNT_REFLECTION 1
#define COUNT_REFRACTION 2
#define COUNT_SHADOW 3
#define COUNT_PRIMARY_HIT 4
#define COUNT_DEPTH_LIMIT 5  // rays not spawned because of max_depth
#define COUNT_MEDIA_STACK_OVERFLOW 6
#define COUNT_NON_FINITE 7           // samples dropped
#define COUNT_STRAY_EXIT 8           // left a medium that had not been entered (an open mesh)
#define COUNT_SHADOW_LIMIT 9         // shadow rays dropped after too many filters
#define COUNT_CAMERA_DEPTH_LIMIT 10  // camera rays going straight on, of those ended by max_depth
#define COUNT_CUT_OFF 11             // rays not spawned because of low throughput; paths have none
#define COUNT_RAY_STACK_OVERFLOW 12  // nor these
#define COUNT_LOST_PIXEL 13          // pixels with overflows of media or stray exits; the host counts them
// Only in scenes with fields:
#define COUNT_MARCH_STEPS 14
#define COUNT_MARCH_LIMIT 15   // marches stopped by their step limit
#define COUNT_MARCH_BACK 16    // relaxed steps that were reverted
#define COUNT_MARCH_BUDGET 17  // marches skipped because the sample's budget was spent
#define COUNT_MARCH_LEFT 18    // not a counter: remaining march budget of a sample (lib/path/fields.cl)
#define COUNT_FINISHED 19      // twice the camera rays of finished work-items (lib/core/counters.cl)
#define COUNTERS 20
// A launch uses several blocks of counters, to be summed: COUNTER_ITEMS consecutive work-items share one, so
// that processors rarely write to the same cache line.
#define COUNTER_BLOCKS 16
#define COUNTER_BLOCK 32  // u32s between blocks
#define COUNTER_ITEMS 32

SUNDOG_SHARED_END
