// Materials, media, the camera and the frame: the tables that shading reads. Colours are linear RGB.
#ifndef SUNDOG_SHARED_SCENE_H
#define SUNDOG_SHARED_SCENE_H
#include "shared/lights.h"
#include "shared/types.h"
SUNDOG_SHARED_BEGIN

#define MATERIAL_PHONG 0u       // local terms and constant kr, kt
#define MATERIAL_DIELECTRIC 1u  // kr, kt from the Fresnel equations; local terms are added when not zero

#define MATERIAL_BLINN 1u          // Blinn's half vector in place of Phong's reflected ray
#define MATERIAL_SHADOW_OPAQUE 2u  // shadow rays stop here even when the material transmits
#define MATERIAL_CHECKER 4u        // ambient and diffuse alternate with checker_ambient and checker_diffuse
#define MATERIAL_TRANSMITS 8u      // kt or Fresnel transmission is not zero
#define MATERIAL_REFLECTS 16u
#define MATERIAL_THIN 32u             // no interior: transmits straight through and changes no medium
#define MATERIAL_VERTEX_COLOR 64u     // ambient and diffuse are multiplied by the vertex colour
#define MATERIAL_CLEAR 128u           // no local terms or tint: cannot be seen between equal indices
#define MATERIAL_METAL_ROUGH 256u     // its terms follow from metalness and roughness (shared/metal_rough.h)
#define MATERIAL_ONE_SIDED 512u       // from behind it is not there
#define MATERIAL_LAYERED 1024u        // layers stand over it (shared/layers.h)
#define MATERIAL_SCATTERS_ONCE 2048u  // its facets give no light back that meets two of them
#define MATERIAL_SHINES 4096u         // it has a highlight: `specular` is not black
#define MATERIAL_EMITS 8192u          // `emission` is not black
#define MATERIAL_FROSTED 16384u       // path tracing: thin, and its facets transmit too
#define MATERIAL_WALL 32768u          // thin, of an index: transmission.w
#define MATERIAL_OFF_CAMERA 65536u    // of a lamp: rays from the camera pass it

// Facets of a lesser width alpha are perfect mirrors and interfaces for paths.
#define LEAST_ALPHA 1e-4f

// Highlights up to this exponent, where it is whole, are products alone.
#define GREATEST_WHOLE_EXPONENT 65535.0f

#define LOBE_STEPS 32u                        // of each table in lobe_energy, along each axis
#define LOBE_GAINS (LOBE_STEPS * LOBE_STEPS)  // where the second begins
#define LOBE_GLASS (2u * LOBE_GAINS)          // where the one of dielectrics begins
#define GLASS_STEPS 20u                       // of that one along alpha and along the cosine
#define GLASS_INDICES 16u                     // and along the root of 1 - 1 / eta, from 0 to GLASS_REACH
#define GLASS_REACH 0.75f

// 144 bytes. Each colour is already multiplied by its coefficient.
typedef struct Material {
  float4 ambient;          // ka
  float4 diffuse;          // kd
  float4 specular;         // ks; w = exponent
  float4 reflection;       // kr (a dielectric's tint, normally 1); w = alpha, the width of rough lobes
  float4 transmission;     // kt (a dielectric's tint, normally 1); w = index of a thin wall
  float4 checker_ambient;  // ka in odd cells
  float4 checker_diffuse;  // kd in odd cells; w = 1 / cell size (object space)
  float4 emission;         // radiance that the outside sends out
  u32 kind;                // MATERIAL_PHONG, MATERIAL_DIELECTRIC
  u32 flags;
  u32 medium;  // index of the medium inside the surface
  u32 maps;    // index of its MaterialMaps; 0: none
} Material;
SUNDOG_SHARED_SIZE(Material, 144)

#define MAX_MEDIA 255  // a ray's stack of media keeps an index in a byte

// 48 bytes. Medium 0 is the world's.
typedef struct Medium {
  float4 absorption;  // light lost, scattered light too, per unit of world length; w = index of refraction
  float4 scattering;  // light scattered, per unit of world length; w = the mean cosine of its turns
  i32 priority;       // the highest wins in an overlap; if equal, the last entered (Schmidt, Budge 2002)
  u32 spectrum;  // path tracing: where its indices begin in the table `spectra`; NO_SPECTRUM: absorption.w
  u32 pad0, pad1;
} Medium;
SUNDOG_SHARED_SIZE(Medium, 48)

// Which ways of finding light path tracing adds: both, each by its share; lights chosen at surfaces alone
// where these can be chosen; those that scattered rays meet alone where they can be met.
#define LIGHT_STRATEGIES(STRATEGY)  \
  STRATEGY(STRATEGY_MIS, mis)       \
  STRATEGY(STRATEGY_LIGHTS, lights) \
  STRATEGY(STRATEGY_SURFACES, surfaces)
#define STRATEGY_MIS 0u
#define STRATEGY_LIGHTS 1u
#define STRATEGY_SURFACES 2u

// Surfaces ask by shafts in scenes of so many instances at most: the answer has a bit for each.
#define SHAFT_INSTANCES 32u

// The part of a light that is worth a ray to it, of SceneInfo.cutoff.
#define LEAST_OF_LIGHT 0x1p-12f

// 400 bytes: the scene's constants. Positions in all tables count from a point of the world, `origin` plus
// `origin_rest`, near what the camera looks at (host/compile/local_origin.h). The pixel (x, y), y down,
// sample offset (a, b) in [0, 1)^2, looks along camera_corner + (x + a) camera_dx + (y + b) camera_dy, which
// has length 1 along camera_forward.
typedef struct SceneInfo {
  float4 camera_position;
  float4 camera_corner;
  float4 camera_dx;
  float4 camera_dy;
  float4 camera_forward;     // unit; w = near clipping depth
  float4 background_bottom;  // w = far clipping depth (may be infinite)
  float4 background_top;     // seen by rays that meet nothing: bottom..top, linear in the elevation's sine
  float4 ambient;            // sum of the ambient lights
  u32 width, height;
  u32 tlas_root;      // first node of the scene BVH, or BVH_LEAF: instance 0 is its only leaf
  u32 bounded_count;  // instances in the scene BVH (0: the BVH is empty)
  u32 instance_count;
  u32 light_count;  // rays that a surface sends to lights: one a light, or with HAS_AREA_LIGHTS light_rays
  u32 material_count, medium_count;
  u32 max_depth;         // 1 = no secondary rays; the camera's ray has depth 1
  u32 samples;           // per pixel
  float cutoff;          // a ray whose greatest throughput component is below it ends
  u32 camera_inside;     // 1: the camera may be inside a solid with a medium; its media stack must be found
  float4 scene_center;   // bounding sphere of all instances but planes and fields; w = radius
  float4 up;             // unit: the scene's up
  float4 fog;            // colour of the world's fog; w = its density per unit of length (0: none)
  u32 field_end;         // instances [instance_count, field_end) place distance fields
  u32 table_lights;      // rows of the table of lights
  u32 sees_environment;  // SEEN_BY_*: rays that meet nothing see the environment, else the background
  u32 texel_page;        // units of TEXEL_UNIT bytes in each of texels0 to texels2
  float4 origin;         // of the tables' coordinates, in the world
  float4 origin_rest;    // what its floats leave out
  // HAS_LENS: from the lens's middle to its rim, to the right and up; w = the depth that is sharp; blades.
  float4 lens_x, lens_y;
  // HAS_CAMERA_MOTION: how far these move while the shutter is open.
  float4 moved_position, moved_corner, moved_dx, moved_dy;
  // Path tracing:
  u32 roulette_depth;  // from this ray on paths end by chance
  u32 light_strategy;  // STRATEGY_*
  u32 guide_count;     // rows of the table `guides`: balls, w = radius
  // Whitted's integrator:
  u32 shafts;       // 1: surfaces ask by shafts what stands before lights with an extent
                    // (lib/light/direct_light.cl)
  u32 seed;         // added to the dimensions of samples, a multiple of four; 0: the default
  u32 transparent;  // 1: what is behind the scene is not seen straight on; alpha says how much
  u32 pad0, pad1;
} SceneInfo;
SUNDOG_SHARED_SIZE(SceneInfo, 400)

// Ray counts of a launch, added with integer atomics (any order gives the same sum).
#define COUNT_PRIMARY 0
#define COUNT_REFLECTION 1
#define COUNT_REFRACTION 2
#define COUNT_SHADOW 3
#define COUNT_MARCH_STEPS 4
#define COUNT_PRIMARY_HIT 5
#define COUNT_CUT_OFF 6      // rays not spawned because of their throughput
#define COUNT_DEPTH_LIMIT 7  // rays not spawned because of max_depth
#define COUNT_RAY_STACK_OVERFLOW 8
#define COUNT_MEDIA_STACK_OVERFLOW 9
#define COUNT_NON_FINITE 10    // samples dropped
#define COUNT_STRAY_EXIT 11    // a medium was left that had not been entered (an open mesh)
#define COUNT_SHADOW_LIMIT 12  // shadow rays given up after too many filters
#define COUNT_MARCH_LIMIT 13   // marches that their step limit ended
#define COUNT_MARCH_BACK 14    // relaxed steps that were taken back
#define COUNT_MARCH_BUDGET 15  // marches not made because the sample's budget was used up
#define COUNT_MARCH_LEFT 16    // no count: what the marches of a sample may still cost (lib/path/fields.cl)
#define COUNT_FINISHED 17      // twice the camera rays of work-items that ended (lib/core/counters.cl)
#define COUNT_CAMERA_DEPTH_LIMIT 18  // of those by max_depth the rays that go straight on from the camera
#define COUNTERS 19
// A launch counts in several blocks, whose sums are its counts: those of COUNTER_ITEMS work-items in a row go
// to one, so that processors seldom write to the same cache line.
#define COUNTER_BLOCKS 16
#define COUNTER_BLOCK 32  // u32 from one to the next
#define COUNTER_ITEMS 32

SUNDOG_SHARED_END
#endif
