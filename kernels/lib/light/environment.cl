// Light from infinitely far away: the environment's picture and suns. A direction a lane.
#ifndef SUNDOG_LIB_ENVIRONMENT_CL
#define SUNDOG_LIB_ENVIRONMENT_CL
#include "lib/core/directions.cl"
#include "lib/core/tables.h"
#include "lib/light/light_sample.cl"
#include "lib/path/camera.cl"

// Where directions lie in the picture: shares of its width and, from the top, of its height.
static inline void environment_place(__global const Environment* e, REAL3 d, REAL* x, REAL* y) {
  const REAL right = dot3(d, all3(e->right.xyz)), ahead = dot3(d, all3(e->ahead.xyz));
  const REAL up = real_clamp(dot3(d, all3(e->up.xyz)), (REAL)(-1.0f), (REAL)(1.0f));
  const REAL turn = fma(atan2(right, ahead), (REAL)(0.5f / M_PI_F), (REAL)(0.5f));
  *x = real_clamp(turn, (REAL)(0.0f), (REAL)(1.0f));
  *y = acos(up) * (1.0f / M_PI_F);
}

// The picture there, blended between the middles of its pixels and round its seam.
static inline float3 environment_texel(const Scene* scene, float x, float y) {
  const u32 width = scene->environments->width, height = scene->environments->height;
  const float across = x * (float)width - 0.5f, down = y * (float)height - 0.5f;
  const float left = floor(across), top = floor(down), a = across - left, b = down - top;
  const u32 x0 = (u32)((int)left + (int)width) % width, x1 = x0 + 1u < width ? x0 + 1u : 0u;
  const u32 y0 = (u32)max((int)top, 0), y1 = min((u32)((int)top + 1), height - 1u);
  __global const float4 *upper = scene->environment + y0 * width, *lower = scene->environment + y1 * width;
  const float3 above = upper[x0].xyz + a * (upper[x1].xyz - upper[x0].xyz);
  const float3 below = lower[x0].xyz + a * (lower[x1].xyz - lower[x0].xyz);
  return above + b * (below - above);
}

// What the environment sends along the directions of `lanes`.
NEVER_INLINE REAL3 environment_along(const Scene* scene, REAL3 d, MASK lanes) {
  REAL x, y;
  environment_place(scene->environments, d, &x, &y);
  REAL3 light = all3((float3)(0.0f));
  for (u32 bits = lane_bits(lanes); bits; bits &= bits - 1u) {
    const u32 i = lowest_bit(bits);
    set3(&light, i, environment_texel(scene, REAL_LANE(x, i), REAL_LANE(y, i)));
  }
  return light;
}

// The last of `count` cells whose running sum begins at or before u: one that has light, for u below 1.
static inline u32 cell_of(__global const float* sums, u32 count, float u) {
  u32 low = 0, high = count - 1u;
  while (low < high) {
    const u32 middle = (low + high + 1u) / 2u;
    if (sums[middle] <= u)
      low = middle;
    else
      high = middle - 1u;
  }
  return low;
}

// The density, per steradian, of the directions of a cell, which are chosen uniformly in it.
static inline float cell_density(const Scene* scene, u32 column, u32 row) {
  __global const Environment* e = scene->environments;
  __global const float* rows = scene->environment_shares;
  __global const float* cells = rows + e->rows + 1u + row * (e->columns + 1u);
  const float share = (rows[row + 1u] - rows[row]) * (cells[column + 1u] - cells[column]);
  const float top = cospi((float)row / (float)e->rows), bottom = cospi((float)(row + 1u) / (float)e->rows);
  return share * (float)e->columns / (2.0f * M_PI_F * (top - bottom));
}

// The density with which sample_environment() chooses the directions.
static inline REAL environment_density(const Scene* scene, REAL3 d, MASK lanes) {
  __global const Environment* e = scene->environments;
  REAL x, y, density = (REAL)(0.0f);
  environment_place(e, d, &x, &y);
  for (u32 bits = lane_bits(lanes); bits; bits &= bits - 1u) {
    const u32 i = lowest_bit(bits);
    const u32 column = min((u32)(REAL_LANE(x, i) * (float)e->columns), e->columns - 1u),
              row = min((u32)(REAL_LANE(y, i) * (float)e->rows), e->rows - 1u);
    REAL_LANE(density, i) = cell_density(scene, column, row);
  }
  return density;
}

// A direction by two numbers in [0, 1): a row of cells by its share of the light, a cell in it, uniformly in
// the cell's solid angle. Returns its density.
static inline float environment_direction(const Scene* scene, float u_x, float u_y, float3* d) {
  __global const Environment* e = scene->environments;
  __global const float* rows = scene->environment_shares;
  const u32 row = cell_of(rows, e->rows, u_y);
  __global const float* cells = rows + e->rows + 1u + row * (e->columns + 1u);
  const u32 column = cell_of(cells, e->columns, u_x);
  const float down = (u_y - rows[row]) / fmax(rows[row + 1u] - rows[row], 1e-37f);
  const float across = (u_x - cells[column]) / fmax(cells[column + 1u] - cells[column], 1e-37f);
  const float top = cospi((float)row / (float)e->rows), bottom = cospi((float)(row + 1u) / (float)e->rows);
  const float up = top + clamp(down, 0.0f, 1.0f) * (bottom - top), side = sqrt(fmax(1.0f - up * up, 0.0f));
  const float turn = 2.0f * ((float)column + clamp(across, 0.0f, 1.0f)) / (float)e->columns - 1.0f;
  *d = up * e->up.xyz + side * (sinpi(turn) * e->right.xyz + cospi(turn) * e->ahead.xyz);
  return cell_density(scene, column, row);
}

static inline LightSamples sample_environment(const Scene* scene, REAL u_x, REAL u_y) {
  LightSamples sample;
  for (u32 i = 0; i < LANES; ++i) {
    float3 d;
    REAL_LANE(sample.density, i) = environment_direction(scene, REAL_LANE(u_x, i), REAL_LANE(u_y, i), &d);
    set3(&sample.wi, i, d);
  }
  sample.distance = (REAL)(INFINITY);
  sample.delta = NO_LANES;
  sample.radiance = environment_along(scene, sample.wi, ALL_LANES);
  return sample;
}

// The density of a sun that is chosen with `chance`, whose disk's size is 1 minus the cosine of its radius.
static inline float sun_density(__global const Light* sun, float chance) {
  return chance / (2.0f * M_PI_F * fabs(sun->direction.w));
}

// Whether directions lie in a sun that is seen. The square of the chord from its middle is twice 1 minus the
// cosine, with more digits.
static inline MASK in_sun(__global const Light* sun, REAL3 d) {
  const REAL3 chord = add3(d, all3(sun->direction.xyz));
  return MASK_OF(dot3(chord, chord) <= 2.0f * sun->direction.w);
}

// Directions to a sun, uniform in its disk in the sky.
static inline LightSamples sample_sun(__global const Light* light, REAL u_x, REAL u_y) {
  const float cap = fabs(light->direction.w);
  const REAL drop = u_x * cap, sine2 = drop * (2.0f - drop);
  LightSamples sample;
  sample.wi = direction_at(all3(-light->direction.xyz), 1.0f - drop, real_sqrt(sine2), u_y);
  sample.distance = (REAL)(INFINITY);
  sample.density = (REAL)(sun_density(light, 1.0f));
  sample.delta = NO_LANES;
  sample.radiance = all3(light->color.xyz);
  return sample;
}

// What lies behind everything: the environment where rays see it, else the background.
static inline bool sees_environment(const Scene* scene) {
  return HAS_ENVIRONMENT && scene->info->sees_environment;
}
static inline REAL3 distant_along(const Scene* scene, REAL3 d, MASK lanes) {
  return sees_environment(scene) ? environment_along(scene, d, lanes) : background_along(scene->info, d);
}

// What the rays of `lanes` see, which meet nothing: that, and the suns in front of it.
static inline REAL3 sky_along(const Scene* scene, REAL3 d, MASK lanes) {
  if (!HAS_SKY) return background_along(scene->info, d);
  REAL3 light = distant_along(scene, d, lanes);
  for (u32 index = 0; index < scene->info->table_lights; ++index) {
    __global const Light* sun = scene->lights + index;
    if (sun->kind != LIGHT_SUN) continue;
    light = select3(light, add3(light, all3(sun->color.xyz)), in_sun(sun, d));
  }
  return light;
}

#endif
