// Light of the environment's picture.
#include "plain/light/light_sample.cl"

// The picture at shares of its width and height, blended between the middles of its pixels and round its
// seam.
float3 environment_at(UNIFORM const Scene* scene, float x, float y, HERE);

// A cell with its share of the light, and a place in it; the luminances of the pixels at the corners of cells
// between pixels: left and right of the top, left and right of the bottom. By two numbers in [0, 1).
typedef struct LANES(ChosenCells) {
  int column, row;
  float share, across, down;
  float corner[4];
} ChosenCell;

void choose_cells(UNIFORM const Scene* scene, float u_x, float u_y, HERE, ChosenCell* cell);

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
  ChosenCell cell;
  choose_cells(scene, u_x, u_y, &cell);
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
