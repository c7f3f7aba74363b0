// One stage: a picture of the first field alone, in one colour: gradient normal, one light with its soft
// shadow, openness. The benchmark's program; a work-item takes LANES neighbouring pixels.
#include "lib/sdf/light.cl"
#include "lib/sdf/surface.cl"

#if LANES == 16 || LANES == 8
#define COLUMNS 4u
#elif LANES == 4
#define COLUMNS 2u
#else
#define COLUMNS 1u
#endif
#define ROWS (LANES / COLUMNS)

// Work-item `item` of the kernel below.
NEVER_INLINE void picture_item(const Scene* scene, __global float* restrict shades,
                               __global u32* restrict counts, float4 origin, float4 right, float4 up,
                               float4 forward, float4 light, u32 width, u32 height, u32 item) {
  const u32 across = width / COLUMNS;
  const u32 x0 = item % across * COLUMNS, y0 = item / across * ROWS;
  REAL x = (REAL)(0.0f), y = (REAL)(0.0f);
  for (u32 i = 0; i < LANES; ++i) {
    REAL_LANE(x, i) = (float)(x0 + i % COLUMNS) + 0.5f;
    REAL_LANE(y, i) = (float)(y0 + i / COLUMNS) + 0.5f;
  }
  const float scale = 2.0f * origin.w / (float)height;
  const REAL a = (x - 0.5f * (float)width) * scale, b = (0.5f * (float)height - y) * scale;
  MarchRays rays;
  rays.origin = real3((REAL)(origin.x), (REAL)(origin.y), (REAL)(origin.z));
  rays.direction = unit3(real3(forward.x + a * right.x + b * up.x, forward.y + a * right.y + b * up.y,
                               forward.z + a * right.z + b * up.z));
  rays.t_min = (REAL)(0.0f);
  rays.t_max = (REAL)(1e20f);
  rays.footprint = (REAL)(0.0f);
  rays.spread = (REAL)(scale);
  rays.active = ALL_LANES;
  rays.step_limit = scene->sdf_fields[0].step_limit;
  rays.inside = NO_LANES;
  rays.leaving = NO_LANES;
  const MarchHits hits = march_rays(scene, 0, &rays);
  REAL shade = (REAL)(0.0f);
  if (any_lane(hits.hit)) {
    const REAL3 p = along3(rays.origin, hits.t, rays.direction);
    const REAL3 normal = sdf_normal(scene, 0, p, hits.threshold, hits.hit, hits.cut);
    const REAL3 wi = real3((REAL)(light.x), (REAL)(light.y), (REAL)(light.z));
    const REAL cosine = fmax(dot3(normal, wi), 0.0f);
    const REAL3 above = along3(p, 2.0f * hits.threshold, normal);
    const REAL open = sdf_openness(scene, 0, above, normal, 0.2f, hits.hit);
    u32 steps_left = scene->sdf_fields[0].step_limit;
    const REAL lit = sdf_soft_shadow(scene, 0, above, wi, 2.0f * hits.threshold, (REAL)(4.0f), 16.0f,
                                     &steps_left, hits.hit & MASK_OF(cosine > 0.0f));
    shade = select(shade, fma(0.8f * cosine, lit, 0.2f * open), hits.hit);
  }
  u32 totals[4] = {0, 0, 0, 0};
  for (u32 i = 0; i < LANES; ++i) {
    shades[(y0 + i / COLUMNS) * width + x0 + i % COLUMNS] = REAL_LANE(shade, i);
    totals[0] += (u32)MASK_LANE(hits.steps, i);
    totals[1] += MASK_LANE(hits.hit, i) ? 1u : 0u;
    totals[2] += MASK_LANE(hits.limited, i) ? 1u : 0u;
    totals[3] += (u32)MASK_LANE(hits.taken_back, i);
  }
  for (u32 i = 0; i < 4u; ++i)
    if (totals[i]) atomic_add(counts + i, totals[i]);
}

// camera: origin (w: tangent of half the angle of view), right, up, forward. light: unit direction towards
// it. Writes a shade a pixel; width and height are multiples of 4. counts: steps, hits, ended by the step
// limit, taken back.
__kernel void field_picture(__global const SdfField* restrict sdf_fields,
                            __global const float* restrict sdf_parameters, __global float* restrict shades,
                            __global u32* restrict counts, float4 origin, float4 right, float4 up,
                            float4 forward, float4 light, u32 width, u32 height) {
  const u32 item = get_global_id(0);
  const Scene scene = {.sdf_fields = sdf_fields, .sdf_parameters = sdf_parameters};
  if (item < width * height / LANES)
    picture_item(&scene, shades, counts, origin, right, up, forward, light, width, height, item);
}
