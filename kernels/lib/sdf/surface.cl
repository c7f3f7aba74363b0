// Shading data of a marched hit: normal and orbit colour.
#pragma once
#include "lib/sdf/march.cl"

// The palette at `trap`, linear between stops and cyclic.
static inline REAL3 palette_color(const Scene* scene, __global const SdfField* restrict field, REAL trap) {
  const REAL turns = fma(trap, (REAL)(field->palette_scale), (REAL)(field->palette_offset));
  const float count = (float)field->palette_count;
  const REAL place = (turns - floor(turns)) * count;
  REAL3 color = real3((REAL)(0.0f), (REAL)(0.0f), (REAL)(0.0f));
  for (u32 i = 0; i < field->palette_count; ++i) {
    const REAL apart = fabs(place - (float)i);
    // Around the circle of stops, from both sides: a single stop is its own neighbour.
    const REAL weight = fmax(1.0f - apart, 0.0f) + fmax(1.0f - (count - apart), 0.0f);
    __global const float* stop = scene->sdf_parameters + field->palette_first + 3u * i;
    color = along3(color, weight, real3((REAL)(stop[0]), (REAL)(stop[1]), (REAL)(stop[2])));
  }
  return color;
}

static inline REAL trap_value(u32 color_by, SdfSample s, REAL3 p) {
  switch (color_by) {
    case SDF_COLOR_POINT:
      return s.point;
    case SDF_COLOR_PLANE:
      return s.plane;
    case SDF_COLOR_AXIS:
      return s.axis;
    case SDF_COLOR_ITERATIONS:
      return s.iterations;
    default:
      return length3(p);
  }
}

// Differences of the estimate at the corners of a tetrahedron (I. Quilez, Normals for an SDF). At the width
// of the threshold they smooth details finer than the pixel; the derivative of a fractal is speckled.
static inline REAL3 difference_normal(const Scene* scene, u32 index, REAL3 p, REAL width, MASK active) {
  REAL3 sum = real3((REAL)(0.0f), (REAL)(0.0f), (REAL)(0.0f));
  for (u32 i = 0; i < 4u; ++i) {
    const REAL x = i == 0u || i == 3u ? width : -width, y = i >= 2u ? width : -width;
    const REAL z = i == 1u || i == 3u ? width : -width;
    const REAL ahead =
        called_estimate(index, real3(p.x + x, p.y + y, p.z + z), active, NO_LANES, scene->sdf_parameters);
    sum = along3(sum, ahead, real3(x, y, z));
  }
  return sum;
}

// As a call, so that the whole formula with traps and gradient is compiled once.
NEVER_INLINE void called_sample(const Scene* scene, u32 index, const REAL3* p, SdfSample* s) {
  *s = sdf_sample(index, *p, scene->sdf_parameters);
}

// The outward unit normal at p, a hit of march_rays, in field space. `cut`: it lies on the interval's
// boundary.
static inline REAL3 sdf_normal(const Scene* scene, u32 index, REAL3 p, REAL threshold, MASK hit, MASK cut) {
  __global const SdfField* restrict field = scene->sdf_fields + index;
  const bool exact = field->flags & SDF_FLAGS & SDF_SMOOTH;
  REAL3 gradient = all3((float3)(1.0f));
  if (exact) {
    SdfSample s;
    called_sample(scene, index, &p, &s);
    gradient = s.gradient;
  }
  // On edges, and where a minimum switches on the surface, a closed form may have no gradient.
  const MASK lost = exact ? hit & MASK_OF(dot3(gradient, gradient) < 1e-20f) : hit;
  if (any_lane(lost))
    gradient =
        select3(gradient, difference_normal(scene, index, p, threshold * field->normal_width, lost), lost);
  const REAL3 normal = unit3(gradient);
  return any_lane(cut) ? select3(normal, cut_normal(field, p), cut) : normal;
}

// The point p in field space.
#ifdef SDF_DEEP
static inline REAL3 trap_place(const Scene* scene, u32 index, REAL3 p) {
  return sdf_place(index, p, scene->sdf_parameters);
}
#else
static inline REAL3 trap_place(const Scene* scene, u32 index, REAL3 p) { return p; }
#endif

// A factor from the orbit trap on the material's ambient and diffuse colours at p, linear.
static inline REAL3 sdf_color(const Scene* scene, u32 index, REAL3 p) {
  __global const SdfField* restrict field = scene->sdf_fields + index;
  if (field->color_by == SDF_COLOR_NONE) return all3((float3)(1.0f));
  SdfSample s;
  called_sample(scene, index, &p, &s);
  return palette_color(scene, field, trap_value(field->color_by, s, trap_place(scene, index, p)));
}
