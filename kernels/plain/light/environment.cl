// Light of the environment's picture.
#include "plain/light/light_sample.cl"

// The picture at shares of its width and height, blended between the middles of its pixels and round its
// seam.
static float3 environment_at(UNIFORM const Scene* scene, float x, float y) {
  const int width = (int)scene->environments->width, height = (int)scene->environments->height;
  const float across = x * (float)width - 0.5f, down = y * (float)height - 0.5f;
  const float left = floor(across), top = floor(down), a = across - left, b = down - top;
  const int column = (int)left, row = (int)top, x0 = column < 0 ? column + width : column;
  const int x1 = x0 + 1 < width ? x0 + 1 : 0, y0 = max(row, 0) * width, y1 = min(row + 1, height - 1) * width;
  __global const float4* pixels = scene->environment;
  const float3 first = pixels[y0 + x0].xyz, second = pixels[y1 + x0].xyz;
  const float3 above = first + a * (pixels[y0 + x1].xyz - first),
               below = second + a * (pixels[y1 + x1].xyz - second);
  return above + b * (below - above);
}

// A cell with its share of the light, and a place in it; the luminances of the pixels at the corners of cells
// between pixels: left and right of the top, left and right of the bottom.
typedef struct ChosenCell {
  int column, row;
  float share, across, down;
  float corner[4];
} ChosenCell;

// Of `count` running sums from `first` on, with their words from `words` on: the last step that begins at or
// before u, one that has light, for u in [0, 1); `place`: where in it u lies. Found between cutpoints (Chen
// and Asau 1974, "On Generating Random Variates from an Empirical Distribution").
static inline int choose_step(UNIFORM const Scene* scene, int first, int words, UNIFORM u32 count, float u,
                              float* share, float* place) {
  __global const float* sums = scene->environment_shares;
  const u32 cutpoints = CUTPOINTS_OF(count);
  const u32 piece = min((u32)(u * (float)cutpoints), cutpoints - 1u);
  const u32 word = scene->environment_cutpoints[words + (int)piece];
  int low = (int)(word & ((1u << CUTPOINT_SHIFT) - 1u)), high = (int)(word >> CUTPOINT_SHIFT);
  while (low < high) {
    const int middle = (low + high + 1) >> 1;
    if (sums[first + middle] <= u)
      low = middle;
    else
      high = middle - 1;
  }
  const float begin = sums[first + low];
  *share = sums[first + low + 1] - begin;
  *place = real_clamp((u - begin) / real_max(*share, 1e-37f), 0.0f, 1.0f);
  return low;
}

static ChosenCell choose_cell(UNIFORM const Scene* scene, float u_x, float u_y) {
  __global const Environment* e = scene->environments;
  const int rows = (int)e->rows, columns = (int)e->columns;
  ChosenCell cell;
  float in_row;
  cell.row = choose_step(scene, rows + 1, 0, e->rows, u_y, &cell.share, &cell.down);
  cell.column = choose_step(scene, cell.row * (columns + 1) + 2 * (rows + 1),
                            cell.row * (int)CUTPOINTS_OF(e->columns) + (int)CUTPOINTS_OF(e->rows), e->columns,
                            u_x, &in_row, &cell.across);
  cell.share *= in_row;
  for (u32 i = 0; i < 4u; ++i) cell.corner[i] = 0.0f;
  if (e->up.w == CELLS_BETWEEN_PIXELS) {
    const int width = (int)e->width, left = (cell.column != 0 ? cell.column : width) - 1;
    const int above = (max(cell.row, 1) - 1) * width, below = min(cell.row, (int)e->height - 1) * width;
    cell.corner[0] = scene->environment[above + left].w;
    cell.corner[1] = scene->environment[above + cell.column].w;
    cell.corner[2] = scene->environment[below + left].w;
    cell.corner[3] = scene->environment[below + cell.column].w;
  }
  return cell;
}

// Where a direction lies in the picture: shares of its width and, from the top, of its height.
static inline void environment_place(UNIFORM __global const Environment* e, float3 d, float* x, float* y) {
  const float right = dot(d, e->right.xyz), ahead = dot(d, e->ahead.xyz);
  const float up = real_clamp(dot(d, e->up.xyz), -1.0f, 1.0f);
  const float turn = fma(atan2(right, ahead), 0.5f / M_PI_F, 0.5f);
  *x = real_clamp(turn, 0.0f, 1.0f);
  *y = real_acos(up) * (1.0f / M_PI_F);
}

// The share of a step of the running sums that begin at `first`.
static inline float share_of_step(UNIFORM const Scene* scene, int first, int step) {
  return scene->environment_shares[first + step + 1] - scene->environment_shares[first + step];
}

static inline float mixed(float from, float to, float part) { return fma(part, to - from, from); }

// The place in [0, 1] by the number u, where the density goes evenly from `from` to `to`.
static inline float place_by_slope(float u, float from, float to) {
  const float v = real_max(u, 1e-7f), sum = from + to;
  const float root = real_sqrt(mixed(from * from, to * to, v));
  return sum > 0.0f ? real_min(v * sum / nonzero(from + root), 1.0f) : v;
}

// Moves the place in a cell between pixels, even in [0, 1], to where luminance puts it.
static inline void place_by_light(ChosenCell* cell) {
  const float a = cell->corner[0], b = cell->corner[1], c = cell->corner[2], d = cell->corner[3];
  cell->down = place_by_slope(cell->down, a + b, c + d);
  cell->across = place_by_slope(cell->across, mixed(a, c, cell->down), mixed(b, d, cell->down));
}

// The density, per steradian, of directions that rows of cells between pixels choose by their radiance.
static inline float blended_pdf(UNIFORM const Scene* scene, float3 radiance, int row, float sine) {
  const float light = fma(0.0722f, radiance.z, fma(0.7152f, radiance.y, 0.2126f * radiance.x));
  return light * scene->environment_shares[row] / real_max(sine, 1e-6f);
}

// The density, per steradian, of the directions of cells with the share `share`, which are chosen evenly
// in them; `height`: the difference of the cosines of their row's borders.
static inline float even_pdf(UNIFORM __global const Environment* e, float share, float height) {
  return share * (float)e->columns / (2.0f * M_PI_F * height);
}

// The environment's radiance along a direction, and the density with which sample_environment() chooses
// it.
ENTRY static inline float3 environment_along(UNIFORM const Scene* scene, float3 d, float* pdf) {
  __global const Environment* e = scene->environments;
  float x, y;
  environment_place(e, d, &x, &y);
  const float3 radiance = environment_at(scene, x, y);
  if (e->up.w == CELLS_BETWEEN_PIXELS) {
    float sine, cosine;
    sincos_of_turn(0.5f * y, &sine, &cosine);
    *pdf = blended_pdf(scene, radiance, (int)fma(y, (float)e->height, 0.5f), sine);
    return radiance;
  }
  const int column = min((int)(x * (float)e->columns), (int)e->columns - 1),
            row = min((int)(y * (float)e->rows), (int)e->rows - 1), above = (int)e->rows + 1;
  const float row_share = share_of_step(scene, above, row),
              share = share_of_step(scene, row * ((int)e->columns + 1) + 2 * above, column);
  const float height = scene->environment_shares[row] - scene->environment_shares[row + 1];
  *pdf = even_pdf(e, share * row_share, height);
  return radiance;
}

// A direction by two numbers in [0, 1): a row of cells by its share of the light, a cell in it, a place
// there.
ENTRY static inline LightSample sample_environment(UNIFORM const Scene* scene, float u_x, float u_y) {
  __global const Environment* e = scene->environments;
  ChosenCell cell = choose_cell(scene, u_x, u_y);
  LightSample sample;
  sample.pdf = 0.0f;
  float x, y, up, side, sine, cosine;
  if (e->up.w == CELLS_BETWEEN_PIXELS) {
    place_by_light(&cell);
    const float height = (float)e->height, row = (float)cell.row;
    const float top = real_max(row - 0.5f, 0.0f), bottom = real_min(row + 0.5f, height);
    x = ((float)cell.column + cell.across - 0.5f) / (float)e->width;
    y = mixed(top, bottom, cell.down) / height;
    sincos_of_turn(0.5f * y, &side, &up);
  } else {
    const float top = scene->environment_shares[cell.row],
                height = top - scene->environment_shares[cell.row + 1];
    x = ((float)cell.column + cell.across) / (float)e->columns;
    up = fma(-cell.down, height, top);
    side = real_sqrt(real_max(fma(-up, up, 1.0f), 0.0f));
    y = real_acos(real_clamp(up, -1.0f, 1.0f)) * (1.0f / M_PI_F);
    sample.pdf = even_pdf(e, cell.share, height);
  }
  sincos_of_turn(x - 0.5f, &sine, &cosine);
  sample.wi = along(along(e->up.xyz * up, side * sine, e->right.xyz), side * cosine, e->ahead.xyz);
  sample.distance = INFINITY;
  sample.delta = false;
  sample.radiance = environment_at(scene, x, y);
  if (e->up.w == CELLS_BETWEEN_PIXELS) sample.pdf = blended_pdf(scene, sample.radiance, cell.row, side);
  return sample;
}
