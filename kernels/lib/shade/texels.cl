// Samples images: fetches, decodes and filters texels of tiled mip levels (Williams 1983, "Pyramidal
// Parametrics"), without the device's image support. One point per lane, all in one image.
#pragma once
#include "lib/core/lanes.h"
#include "lib/core/tables.h"

static inline REAL4 mix4(REAL4 a, REAL4 b, REAL t) {
  return real4(fma(t, b.x - a.x, a.x), fma(t, b.y - a.y, a.y), fma(t, b.z - a.z, a.z),
               fma(t, b.w - a.w, a.w));
}

#if TEXTURE_KINDS
#define HAS_FORMAT(format) (TEXEL_FORMATS >> (format) & 1u)
#define HAS_WIDE_TEXELS (HAS_FORMAT(TEXEL_RGBA16) | HAS_FORMAT(TEXEL_RGBA_HALF))  // of 8 bytes

#if HAS_TEXEL_PAGES
// Word `word`, equal in all lanes, of the texels at `unit`.
static inline MASK paged_words(const Scene* scene, MASK unit, u32 word, MASK lanes) {
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
}
// The words `word`, 0 to 3, of the texels at `unit`.
static inline MASK texel_words(const Scene* scene, MASK unit, MASK word, MASK lanes) {
  MASK words = NO_LANES;
  for (u32 k = 0; k < 4u; ++k) {
    const MASK mine = lanes & MASK_OF(word == (int)k);
    if (any_lane(mine)) words |= paged_words(scene, unit, k, mine);
  }
  return words;
}
#else
static inline MASK texel_words(const Scene* scene, MASK unit, MASK word, MASK lanes) {
  return gather_words(scene->texels0, unit * (int)(TEXEL_UNIT / 4u) + word, lanes);
}
#endif

// Converts finite halves in the low bits of words.
static inline REAL floats_of_halves(MASK bits) {
  return AS_REAL((bits & 0x8000) << 16 | (bits & 0x7FFF) << 13) * 0x1p112f;
}
static inline REAL floats_of_words(MASK bits, u32 format) {
  return format & TEXEL_WORDS ? TO_REAL(bits & 0xFFFF) * (1.0f / 65535.0f) : floats_of_halves(bits);
}
static inline REAL floats_of_bytes(const Scene* scene, MASK bytes, bool srgb, MASK lanes) {
  return srgb ? gather_floats(scene->texture_values, bytes, lanes) : TO_REAL(bytes) * (1.0f / 255.0f);
}

// A mip level per lane.
typedef struct TexelLevels {
  MASK first, width, height;
} TexelLevels;

static inline TexelLevels levels_of_image(const Scene* scene, __global const TextureNode* node, MASK number,
                                          MASK lanes) {
  // Most batches use one level. Values must be valid in inactive lanes too.
  const u32 bits = lane_bits(lanes), one = (u32)MASK_LANE(number, lowest_bit(bits ? bits : 1u));
  if (LANES > 1 && !any_lane(lanes & MASK_OF(number != (MASK)((int)one)))) {
    __global const TexelLevel* same = scene->texel_levels + node->first + one;
    const TexelLevels level = {(MASK)((int)same->first), (MASK)((int)same->width), (MASK)((int)same->height)};
    return level;
  }
  __global const u32* levels = (__global const u32*)(scene->texel_levels + node->first);
  const TexelLevels level = {gather_words(levels, 4 * number, lanes),
                             gather_words(levels, 4 * number + 1, lanes),
                             gather_words(levels, 4 * number + 2, lanes)};
  return level;
}

// Undecoded texels.
typedef struct StoredTexels {
  MASK words, more;  // the second word of 8-byte texels
  MASK byte;         // of smaller texels: offset in their tile
} StoredTexels;

// Fetches the texels (x, y) of levels.
static inline StoredTexels fetch_texels(const Scene* scene, const TexelLevels* level, u32 format, MASK x,
                                        MASK y, MASK lanes) {
  const int size = (int)(format & TEXEL_SIZE_MASK);
  const MASK tile = (y >> 2) * ((level->width + 3) >> 2) + (x >> 2), in_tile = (y & 3) * 4 + (x & 3);
  // A tile starts at a unit boundary; its texels' units follow.
  const MASK byte = in_tile << size;
  const MASK unit = level->first + (tile << size) + (byte >> 4), word = (byte >> 2) & 3;
  StoredTexels texels = {NO_LANES, NO_LANES, byte};
  texels.words = texel_words(scene, unit, word, lanes);
  if (HAS_WIDE_TEXELS && size == 3) texels.more = texel_words(scene, unit, word + 1, lanes);
  return texels;
}

// Decodes to linear values. Colour bytes use a table.
static inline REAL4 decode_texels(const Scene* scene, const StoredTexels* texels, u32 flags, MASK lanes) {
  const u32 format = flags >> TEXTURE_FORMAT_SHIFT & 15u;
  const bool srgb = flags & TEXTURE_SRGB;
  const REAL one = (REAL)(1.0f);
  const MASK words = texels->words;
  if (HAS_FORMAT(TEXEL_RGBA8) && format == TEXEL_RGBA8)
    return real4(floats_of_bytes(scene, words & 0xFF, srgb, lanes),
                 floats_of_bytes(scene, words >> 8 & 0xFF, srgb, lanes),
                 floats_of_bytes(scene, words >> 16 & 0xFF, srgb, lanes),
                 TO_REAL(words >> 24 & 0xFF) * (1.0f / 255.0f));
  if (HAS_FORMAT(TEXEL_GREY8) && format == TEXEL_GREY8) {
    const REAL grey = floats_of_bytes(scene, words >> ((texels->byte & 3) * 8) & 0xFF, srgb, lanes);
    return real4(grey, grey, grey, one);
  }
  if ((HAS_FORMAT(TEXEL_GREY16) | HAS_FORMAT(TEXEL_GREY_HALF)) && (format & TEXEL_SIZE_MASK) == 1u) {
    const REAL grey = floats_of_words(words >> ((texels->byte & 2) * 8), format);
    return real4(grey, grey, grey, one);
  }
  if (!HAS_WIDE_TEXELS) return real4(one, one, one, one);
  return real4(floats_of_words(words, format), floats_of_words(words >> 16 & 0xFFFF, format),
               floats_of_words(texels->more, format), floats_of_words(texels->more >> 16 & 0xFFFF, format));
}

// Wraps coordinates to [0, 1]. NaN becomes 0.
static inline REAL wrap(REAL x, u32 mode) {
  x = select((REAL)(0.0f), x, MASK_OF(fabs(x) < 1e9f));
  if (mode == WRAP_REPEAT) return x - floor(x);
  if (mode == WRAP_MIRROR) return 1.0f - fabs(1.0f - (x - 2.0f * floor(0.5f * x)));
  return real_clamp(x, (REAL)(0.0f), (REAL)(1.0f));
}

// Wraps texel indices at most one off a row of `size`; valid for any index.
static inline MASK wrap_texel(MASK x, MASK size, u32 mode) {
  if (mode == WRAP_REPEAT) {
    x = select(x, x + size, MASK_OF(x < 0));
    x = select(x, x - size, MASK_OF(x >= size));
  }
  return clamp(x, NO_LANES, size - 1);
}

// The four texels around a point in each lane's level, and interpolation weights.
typedef struct StoredCells {
  StoredTexels corner[4];
  REAL s, t;
} StoredCells;

// Fetches the texels at (u, v) in [0, 1]^2, v down; for nearest sampling only the first.
static inline void fetch_cells(const Scene* scene, __global const TextureNode* node, MASK number, REAL u,
                               REAL v, MASK lanes, StoredCells* cells) {
  const TexelLevels level = levels_of_image(scene, node, number, lanes);
  const u32 flags = node->flags, format = flags >> TEXTURE_FORMAT_SHIFT & 15u;
  const u32 wrap_u = flags >> TEXTURE_WRAP_U_SHIFT & 3u, wrap_v = flags >> TEXTURE_WRAP_V_SHIFT & 3u;
  const float middle = flags & TEXTURE_NEAREST ? 0.0f : 0.5f;
  const REAL x = u * TO_REAL(level.width) - middle, y = v * TO_REAL(level.height) - middle;
  const REAL left = floor(x), top = floor(y);
  cells->s = x - left;
  cells->t = y - top;
  const MASK x0 = wrap_texel(TO_MASK(left), level.width, wrap_u),
             y0 = wrap_texel(TO_MASK(top), level.height, wrap_v);
  cells->corner[0] = fetch_texels(scene, &level, format, x0, y0, lanes);
  if (flags & TEXTURE_NEAREST) return;
  const MASK x1 = wrap_texel(TO_MASK(left) + 1, level.width, wrap_u),
             y1 = wrap_texel(TO_MASK(top) + 1, level.height, wrap_v);
  for (u32 k = 1; k < 4u; ++k)
    cells->corner[k] = fetch_texels(scene, &level, format, k & 1u ? x1 : x0, k & 2u ? y1 : y0, lanes);
}

// Interpolates them.
static inline REAL4 filter_cells(const Scene* scene, u32 flags, const StoredCells* cells, MASK lanes) {
  const REAL zero = (REAL)(0.0f);
  REAL4 row = real4(zero, zero, zero, zero), above = row;
#pragma unroll 1
  for (u32 k = 0; k < 4u; k += 2u) {
    above = row;
    row = decode_texels(scene, &cells->corner[k], flags, lanes);
    if (flags & TEXTURE_NEAREST) break;
    row = mix4(row, decode_texels(scene, &cells->corner[k + 1u], flags, lanes), cells->s);
  }
  return flags & TEXTURE_NEAREST ? row : mix4(above, row, cells->t);
}

// The image at (u, v), v up; `footprint` in texels of the largest level.
NEVER_INLINE REAL4 sample_image(const Scene* scene, __global const TextureNode* node, REAL at_u, REAL at_v,
                                REAL footprint, MASK lanes) {
  const u32 flags = node->flags;
  const REAL u = wrap(at_u, flags >> TEXTURE_WRAP_U_SHIFT & 3u);
  const REAL v = wrap(1.0f - at_v, flags >> TEXTURE_WRAP_V_SHIFT & 3u);
  const REAL last = (REAL)((float)(node->count - 1u)), one = (REAL)(1.0f);
  const REAL wide = select(one, real_min(footprint, (REAL)(1e9f)), MASK_OF(footprint > 1.0f));
  const REAL level = real_min(real_log(wide) * 1.44269504f, last);
  const bool blends = !(flags & (TEXTURE_NEAREST | TEXTURE_BILINEAR));
  const MASK number = TO_MASK(blends ? level : level + 0.5f);
  const REAL between = level - TO_REAL(number);
  const MASK two = blends ? lanes & MASK_OF(between > 0.0f) : NO_LANES;
  const u32 levels = any_lane(two) ? 2u : 1u;
  // Fetch all texels before decoding the first, so that memory accesses overlap.
  StoredCells cells[2];
  for (u32 k = 0; k < levels; ++k)
    fetch_cells(scene, node, number + (int)k, u, v, k ? two : lanes, &cells[k]);
  REAL4 value = filter_cells(scene, flags, &cells[0], lanes);
  if (levels == 2u)
    value = mix4(value, filter_cells(scene, flags, &cells[1], two), select((REAL)(0.0f), between, two));
  return value;
}
#endif
