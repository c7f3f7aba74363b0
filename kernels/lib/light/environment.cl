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
  *y = real_acos(up) * (1.0f / M_PI_F);
}

// The picture there, blended between the middles of its pixels and round its seam.
NEVER_INLINE REAL3 environment_at(const Scene* scene, REAL x, REAL y, MASK lanes) {
  const int width = (int)scene->environments->width, height = (int)scene->environments->height;
  const REAL across = x * (float)width - 0.5f, down = y * (float)height - 0.5f;
  const REAL left = floor(across), top = floor(down), a = across - left, b = down - top;
  const MASK column = TO_MASK(left), row = TO_MASK(top),
             x0 = select(column, column + width, MASK_OF(column < 0));
  const MASK x1 = select((MASK)(0), x0 + 1, MASK_OF(x0 + 1 < width));
  const MASK y0 = max(row, (MASK)(0)) * width, y1 = min(row + 1, (MASK)(height - 1)) * width;
  REAL3 light = all3((float3)(0.0f));
  for (u32 bits = lane_bits(lanes); bits; bits &= bits - 1u) {
    const u32 i = lowest_bit(bits);
    __global const float4 *upper = scene->environment + MASK_LANE(y0, i),
                          *lower = scene->environment + MASK_LANE(y1, i);
    const int p = MASK_LANE(x0, i), q = MASK_LANE(x1, i);
    const float4 above = upper[p] + REAL_LANE(a, i) * (upper[q] - upper[p]);
    const float4 below = lower[p] + REAL_LANE(a, i) * (lower[q] - lower[p]);
    set3(&light, i, (above + REAL_LANE(b, i) * (below - above)).xyz);
  }
  return light;
}

// Running sums: where they begin in environment_shares, where their cutpoints do, and how many steps they
// have.
typedef struct RunningSums {
  MASK first, cutpoints;
  u32 count;
} RunningSums;

static inline RunningSums sums_of_rows(__global const Environment* e) {
  const RunningSums sums = {(MASK)((int)e->rows + 1), NO_LANES, e->rows};
  return sums;
}
static inline RunningSums sums_of_cells(__global const Environment* e, MASK row) {
  const int rows = (int)e->rows, columns = (int)e->columns;
  const RunningSums sums = {row * (columns + 1) + 2 * (rows + 1), row * columns + rows, e->columns};
  return sums;
}

// The last step that begins at or before u: one that has light, for u in [0, 1). Found between cutpoints
// (Chen and Asau 1974, "On Generating Random Variates from an Empirical Distribution").
static inline MASK step_of(const Scene* scene, const RunningSums* sums, REAL u, MASK lanes) {
  const MASK bucket = min(TO_MASK(u * (float)sums->count), (MASK)((int)sums->count - 1));
  const MASK word = gather_words(scene->environment_cutpoints, sums->cutpoints + bucket, lanes);
  MASK low = word & (int)((1u << CUTPOINT_SHIFT) - 1u), high = word >> (int)CUTPOINT_SHIFT;
  for (MASK open = lanes & MASK_OF(low < high); any_lane(open); open = lanes & MASK_OF(low < high)) {
    const MASK middle = (low + high + 1) >> 1;
    const REAL sum = gather_floats(scene->environment_shares, sums->first + middle, open);
    const MASK before = MASK_OF(sum <= u);
    low = select(low, middle, open & before);
    high = select(high, middle - 1, open & ~before);
  }
  return low;
}

// Where a step of running sums begins, and how large it is.
static inline REAL step_begin(const Scene* scene, const RunningSums* sums, MASK step, MASK lanes,
                              REAL* size) {
  const REAL from = gather_floats(scene->environment_shares, sums->first + step, lanes);
  *size = gather_floats(scene->environment_shares, sums->first + step + 1, lanes) - from;
  return from;
}

static inline REAL mix_lanes(REAL from, REAL to, REAL part) { return fma(part, to - from, from); }

// The place in [0, 1] by the number u, where the density goes evenly from `from` to `to`.
static inline REAL place_by_slope(REAL u, REAL from, REAL to) {
  const REAL v = real_max(u, (REAL)(1e-7f)), sum = from + to;
  const REAL root = real_sqrt(mix_lanes(from * from, to * to, v));
  return select(v, real_min(v * sum / nonzero(from + root), (REAL)(1.0f)), MASK_OF(sum > 0.0f));
}

// Moves places in cells between the middles of four pixels, even in [0, 1], to where luminance puts them.
static inline void place_by_light(const Scene* scene, MASK column, MASK row, REAL* across, REAL* down) {
  const int width = (int)scene->environments->width, height = (int)scene->environments->height;
  const MASK left = select(column - 1, (MASK)(width - 1), MASK_OF(column == 0)),
             top = max(row - 1, (MASK)(0)) * width, bottom = min(row, (MASK)(height - 1)) * width;
  __global const float* luminance = (__global const float*)scene->environment + 3;
  const REAL a = gather_floats(luminance, (top + left) * 4, ALL_LANES),
             b = gather_floats(luminance, (top + column) * 4, ALL_LANES),
             c = gather_floats(luminance, (bottom + left) * 4, ALL_LANES),
             d = gather_floats(luminance, (bottom + column) * 4, ALL_LANES);
  *down = place_by_slope(*down, a + b, c + d);
  *across = place_by_slope(*across, mix_lanes(a, c, *down), mix_lanes(b, d, *down));
}

static inline REAL row_fact(const Scene* scene, MASK row, MASK lanes) {
  return gather_floats(scene->environment_shares, row, lanes);
}

// The density, per steradian, of directions that rows of cells between pixels choose by their radiance.
static inline REAL blended_density(const Scene* scene, REAL3 radiance, MASK row, REAL sine, MASK lanes) {
  const REAL light =
      fma((REAL)(0.0722f), radiance.z, fma((REAL)(0.7152f), radiance.y, (REAL)(0.2126f) * radiance.x));
  return light * row_fact(scene, row, lanes) / real_max(sine, (REAL)(1e-6f));
}

// The density, per steradian, of the directions of cells with the share `share`, which are chosen evenly in
// them; `height`: the difference of the cosines of their row's borders.
static inline REAL even_density(__global const Environment* e, REAL share, REAL height) {
  return share * (float)e->columns / (2.0f * M_PI_F * height);
}

// What the environment sends along the directions of `lanes`, and the density with which
// sample_environment() chooses them.
static inline REAL3 environment_along(const Scene* scene, REAL3 d, MASK lanes, REAL* density) {
  __global const Environment* e = scene->environments;
  REAL x, y;
  environment_place(e, d, &x, &y);
  const REAL3 radiance = environment_at(scene, x, y, lanes);
  if (e->up.w == CELLS_BETWEEN_PIXELS) {
    REAL sine, cosine;
    sincos_of_turn(0.5f * y, &sine, &cosine);
    const MASK row = TO_MASK(fma(y, (REAL)((float)e->height), (REAL)(0.5f)));
    *density = blended_density(scene, radiance, row, sine, lanes);
    return radiance;
  }
  const MASK column = min(TO_MASK(x * (float)e->columns), (MASK)((int)e->columns - 1)),
             row = min(TO_MASK(y * (float)e->rows), (MASK)((int)e->rows - 1));
  const RunningSums rows = sums_of_rows(e), cells = sums_of_cells(e, row);
  REAL row_share, share;
  step_begin(scene, &rows, row, lanes, &row_share);
  step_begin(scene, &cells, column, lanes, &share);
  *density =
      even_density(e, share * row_share, row_fact(scene, row, lanes) - row_fact(scene, row + 1, lanes));
  return radiance;
}

// Directions by two numbers in [0, 1): a row of cells by its share of the light, a cell in it, a place there.
static inline LightSamples sample_environment(const Scene* scene, REAL u_x, REAL u_y) {
  __global const Environment* e = scene->environments;
  const REAL zero = (REAL)(0.0f), one = (REAL)(1.0f), least = (REAL)(1e-37f);
  const RunningSums rows = sums_of_rows(e);
  const MASK row = step_of(scene, &rows, u_y, ALL_LANES);
  const RunningSums cells = sums_of_cells(e, row);
  const MASK column = step_of(scene, &cells, u_x, ALL_LANES);
  REAL row_share, share, x, y, up, side;
  const REAL row_from = step_begin(scene, &rows, row, ALL_LANES, &row_share),
             from = step_begin(scene, &cells, column, ALL_LANES, &share);
  REAL down = real_clamp((u_y - row_from) / real_max(row_share, least), zero, one),
       across = real_clamp((u_x - from) / real_max(share, least), zero, one);
  LightSamples sample;
  const bool blended = e->up.w == CELLS_BETWEEN_PIXELS;
  if (blended) {
    place_by_light(scene, column, row, &across, &down);
    const float height = (float)e->height;
    const REAL top = real_max(TO_REAL(row) - 0.5f, zero),
               bottom = real_min(TO_REAL(row) + 0.5f, (REAL)(height));
    x = (TO_REAL(column) + across - 0.5f) / (float)e->width;
    y = mix_lanes(top, bottom, down) / height;
    sincos_of_turn(0.5f * y, &side, &up);
  } else {
    const REAL top = row_fact(scene, row, ALL_LANES), height = top - row_fact(scene, row + 1, ALL_LANES);
    x = (TO_REAL(column) + across) / (float)e->columns;
    up = fma(-down, height, top);
    side = real_sqrt(real_max(fma(-up, up, one), zero));
    y = real_acos(real_clamp(up, -one, one)) * (1.0f / M_PI_F);
    sample.density = even_density(e, share * row_share, height);
  }
  REAL sine, cosine;
  sincos_of_turn(x - 0.5f, &sine, &cosine);
  sample.wi = along3(along3(scale3(all3(e->up.xyz), up), side * sine, all3(e->right.xyz)), side * cosine,
                     all3(e->ahead.xyz));
  sample.distance = (REAL)(INFINITY);
  sample.delta = NO_LANES;
  sample.radiance = environment_at(scene, x, y, ALL_LANES);
  if (blended) sample.density = blended_density(scene, sample.radiance, row, side, ALL_LANES);
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

// What lies behind everything: the environment where rays see it, with the density of choosing it, else the
// background.
static inline bool sees_environment(const Scene* scene) {
  return HAS_ENVIRONMENT && scene->info->sees_environment;
}
static inline REAL3 distant_along(const Scene* scene, REAL3 d, MASK lanes, REAL* density) {
  return sees_environment(scene) ? environment_along(scene, d, lanes, density)
                                 : background_along(scene->info, d);
}

// What the rays of `lanes` see, which meet nothing: that, and the suns in front of it.
static inline REAL3 sky_along(const Scene* scene, REAL3 d, MASK lanes) {
  if (!HAS_SKY) return background_along(scene->info, d);
  REAL density;
  REAL3 light = distant_along(scene, d, lanes, &density);
  for (u32 index = 0; index < scene->info->table_lights; ++index) {
    __global const Light* sun = scene->lights + index;
    if (sun->kind != LIGHT_SUN) continue;
    light = select3(light, add3(light, all3(sun->color.xyz)), in_sun(sun, d));
  }
  return light;
}

#endif
