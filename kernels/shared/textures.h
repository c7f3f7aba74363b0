// Textures: what a material may have in place of a colour or a number. A texture is a small graph, kept as a
// row of nodes: each takes what it needs from a stack of values and leaves its own there; the node with
// TEXTURE_LAST is the texture's. Images lie in levels (Williams 1983, "Pyramidal Parametrics") of tiles of
// 4x4 texels, so that the four texels of one sample mostly lie in one line of the cache.
#ifndef SUNDOG_SHARED_TEXTURES_H
#define SUNDOG_SHARED_TEXTURES_H
#include "shared/types.h"
SUNDOG_SHARED_BEGIN

// The kinds of nodes in one list: from it come TEXTURE_* and the description's TextureKind. Bit i of the
// feature TEXTURE_KINDS is set where a scene has kind i. Patterns give a number t, which mixes two colours.
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

#define TEXTURE_LAST 1u          // the texture ends here
#define TEXTURE_SRGB 2u          // an image's bytes become linear by the table at the start of texture_values
#define TEXTURE_NEAREST 4u       // the nearest texel of the nearest level
#define TEXTURE_BILINEAR 8u      // four texels of the nearest level; without both flags eight texels of two
#define TEXTURE_WRAP_U_SHIFT 4u  // WRAP_*
#define TEXTURE_WRAP_V_SHIFT 6u
#define TEXTURE_FORMAT_SHIFT 8u    // TEXEL_*
#define TEXTURE_CHANNEL_SHIFT 12u  // a channel's number, for numbers: all four are then that one
#define TEXTURE_ONE_CHANNEL 0x4000u
#define TEXTURE_MIXES 0x8000u  // t mixes the two values on the stack; else factor and offset hold the colours

#define WRAP_REPEAT 0u
#define WRAP_MIRROR 1u
#define WRAP_CLAMP 2u

// How texels are kept: the two low bits are the logarithm of a texel's bytes, the others its samples.
#define TEXEL_SIZE_MASK 3u
#define TEXEL_WORDS 4u
#define TEXEL_HALVES 8u
#define TEXEL_GREY8 0u
#define TEXEL_RGBA8 2u
#define TEXEL_GREY16 (TEXEL_WORDS | 1u)
#define TEXEL_RGBA16 (TEXEL_WORDS | 3u)
#define TEXEL_GREY_HALF (TEXEL_HALVES | 1u)
#define TEXEL_RGBA_HALF (TEXEL_HALVES | 3u)

// What a texture's coordinates are made from. Bit i of the feature TEXTURE_MAPPINGS is set where a scene has
// i.
#define MAPPING_UV 0u  // the surface's u and v (lib/shade/parametrize.cl); the set is above MAPPING_SET_SHIFT
#define MAPPING_OBJECT 1u       // the point in the object's own units; x and y are u and v
#define MAPPING_SPHERICAL 2u    // longitude about y from +x to -z, and latitude, both over [0, 1]
#define MAPPING_CYLINDRICAL 3u  // longitude and y
#define MAPPING_BOX 4u          // along the three axes, mixed by the normal
#define MAPPING_KIND 0xFFu
#define MAPPING_SET_SHIFT 8u

// 160 bytes.
typedef struct TextureNode {
  float4 rows[3];         // from the object's units to the mapping's
  float4 uv_rows[2];      // xyz: from the mapping's u and v (and 1) to the texture's
  float4 factor, offset;  // the node's value is what its kind gives, times factor, plus offset
  u32 kind;               // TEXTURE_*
  u32 flags;
  u32 mapping;       // MAPPING_*
  u32 first, count;  // levels of an image; stops of a ramp: place, red, green, blue each
  float scale;       // texels (of an image) or units (of a pattern) on a unit of the mapping
  float parameter[6];
} TextureNode;
SUNDOG_SHARED_SIZE(TextureNode, 160)

#define MOST_TEXTURE_STACK 16u

// 16 bytes: a level of an image.
typedef struct TexelLevel {
  u32 first;  // of the texels, in units of TEXEL_UNIT bytes
  u32 width, height;
  u32 row_tiles;
} TexelLevel;
SUNDOG_SHARED_SIZE(TexelLevel, 16)

#define TEXEL_TILE 4u                // texels along a tile's edge
#define TEXEL_UNIT 16u               // bytes
#define TEXEL_ALIGNMENT 8u           // units: the greatest tile, which no page's end cuts
#define TEXEL_PAGE_BYTES 0x8000000u  // of texels0 to texels3, at least: every device has 128 MiB in a piece
#define TEXEL_PAGES 4u               // and a quarter of its memory

// What a material takes from textures, each a factor on the material's own value.
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

// 160 bytes: what a material has beside Material, which counts these from 1. Entry 0 is not used.
typedef struct MaterialMaps {
  u32 slot[20];  // by MAP_*: the first node of a texture, or NO_TEXTURE
  float4 base;   // of a material by metalness and roughness: its colour; w = metalness
  float opacity;
  float roughness;
  float reflectance;    // of a dielectric seen straight on
  float cutoff;         // of the opacity: below it nothing is there, else all; 0: in between as well
  float normal_scale;   // factor on a normal map's x and y
  float bump;           // height of a 1 in the height map, in the object's own units
  float height_texels;  // of the height's image on a unit of u and v; 0: no image
  float occlusion;      // how much of the occlusion counts
  float parallax;       // depth of a 0 of the heights below a 1, which is the surface; 0: no parallax
  float bump_uv;        // the same height in units of u and v
  float coat;           // a clear layer's mirror above all else
  u32 pad;
  float4 normal_turn;  // of a normal map's picture: the ways in u and v, of length 1, that its x and y go
} MaterialMaps;
SUNDOG_SHARED_SIZE(MaterialMaps, 160)

#define SRGB_VALUES 256u  // linear values of bytes, at the start of texture_values

SUNDOG_SHARED_END
#endif
