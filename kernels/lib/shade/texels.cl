// Samples of images: texels of tiled levels, decoded, and filtered between (Williams 1983, "Pyramidal
// Parametrics"). No image support of the device is needed. A point a lane, all of one image.
#ifndef SUNDOG_LIB_TEXELS_CL
#define SUNDOG_LIB_TEXELS_CL
#include "lib/core/lanes.h"
#include "lib/core/tables.h"

typedef struct REAL4 {
  REAL x, y, z, w;
} REAL4;

static inline REAL4 real4(REAL x, REAL y, REAL z, REAL w) {
  const REAL4 r = {x, y, z, w};
  return r;
}
static inline REAL4 mix4(REAL4 a, REAL4 b, REAL t) {
  return real4(fma(t, b.x - a.x, a.x), fma(t, b.y - a.y, a.y), fma(t, b.z - a.z, a.z),
               fma(t, b.w - a.w, a.w));
}
static inline REAL4 select4(REAL4 a, REAL4 b, MASK m) {
  return real4(select(a.x, b.x, m), select(a.y, b.y, m), select(a.z, b.z, m), select(a.w, b.w, m));
}

#if TEXEL_FORMATS
#define HAS_FORMAT(format) (TEXEL_FORMATS & (1u << (format)))

// Word `word` of the texels that begin at `unit`.
static inline MASK texel_words(const Scene* scene, MASK unit, u32 word, MASK lanes) {
#if HAS_TEXEL_PAGES
  const int page = (int)scene->info->texel_page;
  __global const u32* pages[TEXEL_PAGES] = {scene->texels0, scene->texels1, scene->texels2, scene->texels3};
  MASK words = NO_LANES;
  for (u32 number = 0; number < TEXEL_PAGES; ++number) {
    const MASK last = number + 1u == TEXEL_PAGES ? ALL_LANES : MASK_OF(unit < page);
    const MASK mine = lanes & last;
    if (any_lane(mine)) words |= gather_words(pages[number], unit * (int)(TEXEL_UNIT / 4u) + (int)word, mine);
    lanes &= ~last;
    unit -= page;
  }
  return words;
#else
  return gather_words(scene->texels0, unit * (int)(TEXEL_UNIT / 4u) + (int)word, lanes);
#endif
}

// Halves, which are finite, in the low bits of words.
static inline REAL floats_of_halves(MASK bits) {
  return AS_REAL((bits & 0x8000) << 16 | (bits & 0x7FFF) << 13) * 0x1p112f;
}
static inline REAL floats_of_words(MASK bits, u32 format) {
  return format & TEXEL_WORDS ? TO_REAL(bits & 0xFFFF) * (1.0f / 65535.0f) : floats_of_halves(bits);
}
static inline REAL floats_of_bytes(const Scene* scene, MASK bytes, bool srgb, MASK lanes) {
  return srgb ? gather_floats(scene->texture_values, bytes, lanes) : TO_REAL(bytes) * (1.0f / 255.0f);
}

// A level of an image, which differs from lane to lane.
typedef struct TexelLevels {
  MASK first, width, height;
} TexelLevels;

static inline TexelLevels levels_of_image(const Scene* scene, __global const TextureNode* node, MASK number,
                                          MASK lanes) {
  __global const u32* levels = (__global const u32*)(scene->texel_levels + node->first);
  const TexelLevels level = {gather_words(levels, 4 * number, lanes),
                             gather_words(levels, 4 * number + 1, lanes),
                             gather_words(levels, 4 * number + 2, lanes)};
  return level;
}

// The texels (x, y) of levels, linear. Bytes of colours are looked up in a table.
static inline REAL4 texels(const Scene* scene, const TexelLevels* level, u32 flags, MASK x, MASK y,
                           MASK lanes) {
  const u32 format = flags >> TEXTURE_FORMAT_SHIFT & 15u, size = format & TEXEL_SIZE_MASK;
  const bool srgb = flags & TEXTURE_SRGB;
  const REAL one = (REAL)(1.0f);
  const MASK tile = (y >> 2) * ((level->width + 3) >> 2) + (x >> 2), in_tile = (y & 3) * 4 + (x & 3);
  // A tile begins at a unit; the units of its texels follow.
  const MASK byte = in_tile << (int)size;
  const MASK unit = level->first + (tile << (int)size) + (byte >> 4), word = (byte >> 2) & 3;
#if HAS_TEXEL_PAGES
  MASK words = NO_LANES;
  for (u32 k = 0; k < 4u; ++k) {
    const MASK mine = lanes & MASK_OF(word == (int)k);
    if (any_lane(mine)) words |= texel_words(scene, unit, k, mine);
  }
#else
  const MASK words = gather_words(scene->texels0, unit * 4 + word, lanes);
#endif
#if HAS_FORMAT(TEXEL_RGBA8)
  if (format == TEXEL_RGBA8)
    return real4(floats_of_bytes(scene, words & 0xFF, srgb, lanes),
                 floats_of_bytes(scene, words >> 8 & 0xFF, srgb, lanes),
                 floats_of_bytes(scene, words >> 16 & 0xFF, srgb, lanes),
                 TO_REAL(words >> 24 & 0xFF) * (1.0f / 255.0f));
#endif
#if HAS_FORMAT(TEXEL_GREY8)
  if (format == TEXEL_GREY8) {
    const REAL grey = floats_of_bytes(scene, words >> ((byte & 3) * 8) & 0xFF, srgb, lanes);
    return real4(grey, grey, grey, one);
  }
#endif
#if HAS_FORMAT(TEXEL_GREY16) || HAS_FORMAT(TEXEL_GREY_HALF)
  if (size == 1u) {
    const REAL grey = floats_of_words(words >> ((byte & 2) * 8), format);
    return real4(grey, grey, grey, one);
  }
#endif
#if HAS_FORMAT(TEXEL_RGBA16) || HAS_FORMAT(TEXEL_RGBA_HALF)
#if HAS_TEXEL_PAGES
  MASK more = NO_LANES;
  for (u32 k = 1; k < 4u; k += 2u) {
    const MASK mine = lanes & MASK_OF(word + 1 == (int)k);
    if (any_lane(mine)) more |= texel_words(scene, unit, k, mine);
  }
#else
  const MASK more = gather_words(scene->texels0, unit * 4 + word + 1, lanes);
#endif
  return real4(floats_of_words(words, format), floats_of_words(words >> 16 & 0xFFFF, format),
               floats_of_words(more, format), floats_of_words(more >> 16 & 0xFFFF, format));
#else
  return real4(one, one, one, one);
#endif
}

// Coordinates in [0, 1] for ones that repeat or are mirrored. What is not a number becomes 0.
static inline REAL wrap(REAL x, u32 mode) {
  x = select((REAL)(0.0f), x, MASK_OF(fabs(x) < 1e9f));
  if (mode == WRAP_REPEAT) return x - floor(x);
  if (mode == WRAP_MIRROR) return 1.0f - fabs(1.0f - (x - 2.0f * floor(0.5f * x)));
  return real_clamp(x, (REAL)(0.0f), (REAL)(1.0f));
}

// The texels' numbers for ones that are off a row of `size` by one at most; for any, ones of the row.
static inline MASK wrap_texel(MASK x, MASK size, u32 mode) {
  if (mode == WRAP_REPEAT) {
    x = select(x, x + size, MASK_OF(x < 0));
    x = select(x, x - size, MASK_OF(x >= size));
  }
  return clamp(x, NO_LANES, size - 1);
}

// Samples of one level each at (u, v) in [0, 1]^2, v down.
static inline REAL4 sample_levels(const Scene* scene, __global const TextureNode* node, MASK number, REAL u,
                                  REAL v, MASK lanes) {
  const TexelLevels level = levels_of_image(scene, node, number, lanes);
  const u32 flags = node->flags;
  const u32 wrap_u = flags >> TEXTURE_WRAP_U_SHIFT & 3u, wrap_v = flags >> TEXTURE_WRAP_V_SHIFT & 3u;
  const float middle = flags & TEXTURE_NEAREST ? 0.0f : 0.5f;
  const REAL x = u * TO_REAL(level.width) - middle, y = v * TO_REAL(level.height) - middle;
  const REAL left = floor(x), top = floor(y), s = x - left, t = y - top;
  const MASK x0 = TO_MASK(left), y0 = TO_MASK(top);
  REAL4 rows[2];
  for (int row = 0; row < 2; ++row) {
    const MASK yy = wrap_texel(y0 + row, level.height, wrap_v);
    rows[row] = texels(scene, &level, flags, wrap_texel(x0, level.width, wrap_u), yy, lanes);
    if (flags & TEXTURE_NEAREST) return rows[0];
    const REAL4 right = texels(scene, &level, flags, wrap_texel(x0 + 1, level.width, wrap_u), yy, lanes);
    rows[row] = mix4(rows[row], right, s);
  }
  return mix4(rows[0], rows[1], t);
}

// The image at (u, v), v up, where `footprint` is the width of what is seen, in texels of the greatest level.
NEVER_INLINE REAL4 sample_image(const Scene* scene, __global const TextureNode* node, REAL at_u, REAL at_v,
                                REAL footprint, MASK lanes) {
  const u32 flags = node->flags;
  const REAL u = wrap(at_u, flags >> TEXTURE_WRAP_U_SHIFT & 3u);
  const REAL v = wrap(1.0f - at_v, flags >> TEXTURE_WRAP_V_SHIFT & 3u);
  const REAL last = (REAL)((float)(node->count - 1u)), one = (REAL)(1.0f);
  const REAL wide = select(one, real_min(footprint, (REAL)(1e9f)), MASK_OF(footprint > 1.0f));
  const REAL level = real_min(real_log(wide) * 1.44269504f, last);
  if (flags & (TEXTURE_NEAREST | TEXTURE_BILINEAR))
    return sample_levels(scene, node, TO_MASK(level + 0.5f), u, v, lanes);
  const MASK number = TO_MASK(level);
  const REAL between = level - TO_REAL(number);
  const MASK two = lanes & MASK_OF(between > 0.0f);
  const REAL4 fine = sample_levels(scene, node, number, u, v, lanes);
  if (!any_lane(two)) return fine;
  return mix4(fine, sample_levels(scene, node, number + 1, u, v, two), select((REAL)(0.0f), between, two));
}
#endif

#endif
