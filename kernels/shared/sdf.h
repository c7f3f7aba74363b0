// A signed distance field as the marcher sees it: its interval, its bound and how closely it is followed.
// What the field is stands in the generated code; the numbers of its formulas stand in one table of floats.
#ifndef SUNDOG_SHARED_SDF_H
#define SUNDOG_SHARED_SDF_H
#include "shared/types.h"
SUNDOG_SHARED_BEGIN

#define SDF_SMOOTH 1u      // a closed form: hits are refined to the surface itself
#define SDF_CUT_SPHERE 2u  // a sphere cuts the field besides the interval

// What drives the palette.
#define SDF_COLOR_NONE 0u
#define SDF_COLOR_POINT 1u       // least distance of the orbit from the origin
#define SDF_COLOR_PLANE 2u       // least distance from the coordinate planes
#define SDF_COLOR_AXIS 3u        // least distance from the coordinate axes
#define SDF_COLOR_ITERATIONS 4u  // iterations until escape, continuous
#define SDF_COLOR_RADIUS 5u      // the point's own distance from the field's origin

// 128 bytes; lengths are in the field's own space. The threshold at which a ray has arrived is the pixel's
// footprint, kept within [lower.w, upper.w].
typedef struct SdfField {
  float4 lower;   // interval in which the field is built: it cuts the surface; w = least threshold
  float4 upper;   // w = greatest threshold
  float4 sphere;  // xyz centre, w = radius of the cutting sphere (SDF_CUT_SPHERE)
  float safety;   // (0, 1]: the estimate times this never exceeds the true distance
  float detail;   // threshold in pixel footprints
  u32 step_limit;
  u32 flags;          // SDF_SMOOTH, SDF_CUT_SPHERE
  u32 color_by;       // SDF_COLOR_*
  u32 palette_first;  // index of the first stop (three floats each) in the table of parameters
  u32 palette_count;
  float palette_scale;
  float palette_offset;
  float normal_width;     // of the differences that give a fractal's normal, in thresholds
  float occlusion_reach;  // how far off the surface its own crevices take ambient light; 0: they do not
  float shadow_hardness;  // a soft shadow ends 1 / hardness of its length beside the field; 0: sharp
  u32 iterations;         // that one estimate may take at most
  u32 pad0, pad1, pad2;
  float4 glow;  // light that a passing ray gathers; w = distance at which it has fallen to 1 / e
} SdfField;
SUNDOG_SHARED_SIZE(SdfField, 128)

SUNDOG_SHARED_END
#endif
