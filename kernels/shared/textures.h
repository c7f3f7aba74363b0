// Textures, which replace a material's colour or number. A texture is a small graph, stored as a row of nodes
// in postfix order: each pops its operands from a stack and pushes its value; the node with TEXTURE_LAST
// gives the result. Images are mip levels (Williams 1983, "Pyramidal Parametrics") in tiles of 4x4 texels, so
// that a sample's four texels usually share a cache line.
#pragma once
#include "shared/types.h"
SUNDOG_SHARED_BEGIN

// The list of node kinds, which generates TEXTURE_* and the description's TextureKind. Bit i of the feature
// TEXTURE_KINDS is set if a scene has kind i. Patterns give a number t, which mixes two colours.
//   TEXTURE(constant after TEXTURE_, name in scene files)
// A table:
// clang-format off
#define TEXTURES(TEXTURE)                                                                                   \
  TEXTURE(COLOR, color)       /* a constant: the node's offset */                                           \
  TEXTURE(IMAGE, image)       /* a sample of the image whose levels begin at `first` */                     \
  TEXTURE(CHECKER, checker)   /* cells of edge 1 */                                                         \
  TEXTURE(STRIPES, stripes)   /* across x, period 1; parameter 0: the second colour's share */              \
  TEXTURE(GRADIENT, gradient) /* along x from 0 to 1 */                                                     \
  TEXTURE(BRICK, brick)       /* x, y of courses 1 wide and 1 high; parameters 0, 1: mortar's shares of both */ \
  TEXTURE(NOISE, noise)       /* parameters 0, 1, 2: octaves, gain, 1 = gradient noise and 0 = value noise */ \
  TEXTURE(CELLS, cells)       /* distance to the nearest of a point a cell */                               \
  TEXTURE(MARBLE, marble)     /* veins across x; parameters 0, 1, 2: octaves, gain, turbulence */           \
  TEXTURE(WOOD, wood)         /* rings about y; parameters as of marble */                                  \
  TEXTURE(RAMP, ramp)         /* the stops at `first` by the red of the value on the stack */               \
  TEXTURE(PRODUCT, product)   /* of the two values on the stack */                                          \
  TEXTURE(FORMULA, formula)   /* number `count` of generated/patterns.cl, its numbers at `first` */         \
  TEXTURE(VERTEX_COLOR, vertex_color) /* of meshes, with alpha; white elsewhere */
// clang-format on

#define TEXTURE_CONSTANT(constant, name) TEXTURE_##constant,
typedef enum TextureKind SUNDOG_ENUM_OF_U32 { TEXTURES(TEXTURE_CONSTANT) TEXTURE_COUNT } TextureKind;
#undef TEXTURE_CONSTANT

#define TEXTURE_LAST 1u          // last node of the texture
#define TEXTURE_SRGB 2u          // decode image bytes with the table at the start of texture_values
#define TEXTURE_NEAREST 4u       // nearest texel of the nearest level
#define TEXTURE_BILINEAR 8u      // four texels of the nearest level; without both flags trilinear
#define TEXTURE_WRAP_U_SHIFT 4u  // WRAP_*
#define TEXTURE_WRAP_V_SHIFT 6u
#define TEXTURE_FORMAT_SHIFT 8u    // TEXEL_*
#define TEXTURE_CHANNEL_SHIFT 12u  // replicates this channel, for numbers
#define TEXTURE_ONE_CHANNEL 0x4000u
#define TEXTURE_MIXES 0x8000u  // t mixes two values on the stack; else factor and offset hold the colours

#define WRAP_REPEAT 0u
#define WRAP_MIRROR 1u
#define WRAP_CLAMP 2u

// Texel formats: the two low bits are log2 of a texel's bytes, the others its samples.
#define TEXEL_SIZE_MASK 3u
#define TEXEL_WORDS 4u
#define TEXEL_HALVES 8u
#define TEXEL_GREY8 0u
#define TEXEL_RGBA8 2u
#define TEXEL_GREY16 (TEXEL_WORDS | 1u)
#define TEXEL_RGBA16 (TEXEL_WORDS | 3u)
#define TEXEL_GREY_HALF (TEXEL_HALVES | 1u)
#define TEXEL_RGBA_HALF (TEXEL_HALVES | 3u)

// Sources of texture coordinates. Bit i of the feature TEXTURE_MAPPINGS is set if a scene has mapping i.
#define MAPPING_UV 0u      // the surface's u and v (shade/parametrize.cl); the set is above MAPPING_SET_SHIFT
#define MAPPING_OBJECT 1u  // the point in object units; u and v are x and y
#define MAPPING_SPHERICAL 2u    // longitude about y from +x to -z, and latitude, both in [0, 1]
#define MAPPING_CYLINDRICAL 3u  // longitude and y
#define MAPPING_BOX 4u          // along the three axes, blended by the normal
#define MAPPING_KIND 0xFFu
#define MAPPING_SET_SHIFT 8u

// 160 bytes.
typedef struct TextureNode {
  float4 rows[3];         // from object units to the mapping's
  float4 uv_rows[2];      // xyz: from the mapping's (u, v, 1) to the texture's
  float4 factor, offset;  // value = kind's value * factor + offset
  u32 kind;               // TEXTURE_*
  u32 flags;
  u32 mapping;       // MAPPING_*
  u32 first, count;  // levels of an image; stops of a ramp: position, red, green, blue each
  float scale;       // texels (image) or units (pattern) per unit of the mapping
  float parameter[6];
} TextureNode;
SUNDOG_SHARED_SIZE(TextureNode, 160)

#define MOST_TEXTURE_STACK 16u

// 16 bytes: a mip level of an image.
typedef struct TexelLevel {
  u32 first;  // offset in units of TEXEL_UNIT bytes
  u32 width, height;
  u32 row_tiles;
} TexelLevel;
SUNDOG_SHARED_SIZE(TexelLevel, 16)

#define TEXEL_TILE 4u                // texels along a tile's edge
#define TEXEL_UNIT 16u               // bytes
#define TEXEL_ALIGNMENT 8u           // units: the largest tile; pages never split one
#define TEXEL_PAGE_BYTES 0x8000000u  // minimum of texels0 to texels3: every device can allocate 128 MiB
#define TEXEL_PAGES 4u               // and a quarter of its memory at once

// Textures of a material, each a factor on the material's own value.
//   SLOT(constant after MAP_, member of the description's MaterialTextures)
#define MAP_SLOTS(SLOT)                                                          \
  SLOT(AMBIENT, ambient)                                                         \
  SLOT(DIFFUSE, diffuse)                                                         \
  SLOT(SPECULAR, specular)                                                       \
  SLOT(EXPONENT, exponent)                                                       \
  SLOT(REFLECTION, reflection)                                                   \
  SLOT(TRANSMISSION, transmission)                                               \
  SLOT(EMISSION, emission)                                                       \
  SLOT(OPACITY, opacity)                                                         \
  SLOT(NORMAL, normal)           /* tangent space, (0, 0, 1) is 0.5 0.5 1 */     \
  SLOT(HEIGHT, height)           /* along the normal, times MaterialMaps.bump */ \
  SLOT(METAL_ROUGH, metal_rough) /* green: roughness, blue: metalness (glTF) */  \
  SLOT(OCCLUSION, occlusion)     /* red: of ambient light */                     \
  SLOT(COAT, coat)               /* red: of the mirror or coat above all */      \
  SLOT(METALNESS, metalness)     /* of a layered material's base */              \
  SLOT(ROUGHNESS, roughness)                                                     \
  SLOT(GLASS, glass) /* the share of its dielectric that transmits */            \
  SLOT(FUZZ, fuzz)   /* of the color of its fuzz */

#define MAP_CONSTANT(constant, name) MAP_##constant,
typedef enum MapSlot SUNDOG_ENUM_OF_U32 { MAP_SLOTS(MAP_CONSTANT) MAP_COUNT } MapSlot;
#undef MAP_CONSTANT

#define NO_TEXTURE 0xFFFFFFFFu
#define NO_MAPS 0u

// 160 bytes: texture data of a material, indexed from 1 by Material. Entry 0 is unused.
typedef struct MaterialMaps {
  u32 slot[20];  // by MAP_*: first node of a texture, or NO_TEXTURE
  float4 base;   // base colour of a metal-rough material; w = metalness
  float opacity;
  float roughness;
  float reflectance;    // normal reflectance of the dielectric
  float cutoff;         // alpha test: opacity becomes 0 below it and 1 from there on; 0: no test
  float normal_scale;   // factor on a normal map's x and y
  float bump;           // height of 1 in the height map, in object units
  float height_texels;  // texels of the height image per unit of u and v; 0: no image
  float occlusion;      // strength of occlusion
  float parallax;       // depth of height 0 below height 1, which is the surface; 0: no parallax
  float bump_uv;        // likewise in units of u and v
  float coat;           // reflectance of a clear layer on top
  u32 pad;
  float4 normal_turn;  // of a normal map: the unit directions in (u, v) of its x and y
} MaterialMaps;
SUNDOG_SHARED_SIZE(MaterialMaps, 160)

#define SRGB_VALUES 256u  // linear values of bytes, at the start of texture_values

SUNDOG_SHARED_END
