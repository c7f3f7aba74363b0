// A signed distance field as the marcher sees it: interval, safety and precision. Generated code defines the
// field; its formulas' numbers are in one table of floats.
#pragma once
#include "shared/types.h"
SUNDOG_SHARED_BEGIN

#define SDF_SMOOTH 1u      // a closed form: hits are refined to the exact surface
#define SDF_CUT_SPHERE 2u  // a sphere also cuts the field

// The quantity that drives the palette.
#define SDF_COLOR_NONE 0u
#define SDF_COLOR_POINT 1u       // minimum distance of the orbit from the origin
#define SDF_COLOR_PLANE 2u       // minimum distance from the coordinate planes
#define SDF_COLOR_AXIS 3u        // minimum distance from the coordinate axes
#define SDF_COLOR_ITERATIONS 4u  // iterations until escape, continuous
#define SDF_COLOR_RADIUS 5u      // distance of the point from the field's origin

// 128 bytes; lengths are in field space. A ray has arrived at a distance of the pixel's footprint times
// detail, clamped to [lower.w, upper.w].
typedef struct SdfField {
  float4 lower;   // bounding interval, which cuts the surface; w = minimum threshold
  float4 upper;   // w = maximum threshold
  float4 sphere;  // xyz centre, w = radius of the cutting sphere (SDF_CUT_SPHERE)
  float safety;   // (0, 1]: factor that makes the estimate a lower bound
  float detail;   // threshold in pixel footprints
  u32 step_limit;
  u32 flags;          // SDF_SMOOTH, SDF_CUT_SPHERE
  u32 color_by;       // SDF_COLOR_*
  u32 palette_first;  // index of the first stop (three floats each) in the parameter table
  u32 palette_count;
  float palette_scale;
  float palette_offset;
  float normal_width;     // step of the differences for a fractal's normal, in thresholds
  float occlusion_reach;  // search distance of ambient occlusion by crevices; 0: none
  float shadow_hardness;  // a soft shadow's penumbra is 1 / hardness of its length wide; 0: sharp
  u32 iterations;         // maximum per estimate
  u32 pad0, pad1, pad2;
  float4 glow;  // light that a passing ray gathers; w = distance at which it falls to 1 / e
} SdfField;
SUNDOG_SHARED_SIZE(SdfField, 128)

SUNDOG_SHARED_END
