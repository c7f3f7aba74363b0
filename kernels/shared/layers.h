// Layered materials: from above fuzz, a coat, a film, and a base that is a metal or a dielectric over a matte
// ground, in the terms of OpenPBR 1.1 (host/scene/materials/openpbr.h has its names and ranges).
#ifndef SUNDOG_SHARED_LAYERS_H
#define SUNDOG_SHARED_LAYERS_H
#include "shared/types.h"
SUNDOG_SHARED_BEGIN

// Rows of a material in the table layer_rows, each by the cosine to the normal from 0 to 1: the share
// of light that fuzz, coat and the base's interface pass to the layers below; the red, green and blue that a
// film over the interface reflects above a dielectric and above a metal; and gains of the base's facets.
#define LAYER_STEPS 32u
#define LAYER_FUZZ 0u
#define LAYER_COAT 1u
#define LAYER_SHINE 2u
#define LAYER_FILM 3u
#define LAYER_FILM_METAL 6u
#define LAYER_GAINS 9u  // of the base's facets: LAYER_TURNS rows by the square of the part along the tangent
#define LAYER_TURNS 8u
#define LAYER_ROWS (LAYER_GAINS + LAYER_TURNS)

// A coat of two widths has gains of its own; one of facets as wide across as along has those of all such.
#define NO_LAYER_GAINS 0xFFFFFFFFu

// Narrower lobes are widened to this: mirrors are lobes too.
#define LEAST_LAYER_ALPHA 1e-3f

// Where a texture gives the base's roughness, what depends on that is a grid in layer_rows, by the root of
// the widths' mean (what specular_roughness is without a coat) from 0 to 1: first these numbers of each step,
// then of each step its row LAYER_SHINE and its gains: one row where facets are as wide across as along, else
// LAYER_TURNS.
#define LAYER_GRID_STEPS 16u
#define LAYER_GRID_STRAIGHT 0u  // as the members of Layers
#define LAYER_GRID_SHINE_SCALE 1u
#define LAYER_GRID_MATTE_SCALE 2u
#define LAYER_GRID_MATTE_SCALE_BARE 3u
#define LAYER_GRID_NUMBERS 4u
#define NO_LAYER_GRID 0xFFFFFFFFu
// Where one gives the coat's weight, the steps are of that, and all that changes with it is exact in each:
// the base's widths and its index below the coat too. Where textures give both, there are as many grids by
// roughness as steps of the coat's weight. A film's rows lie then behind the material's own,
// LAYER_FILM_ROWS for each step of the coat's weight.
#define LAYER_FILM_ROWS (LAYER_GAINS - LAYER_FILM)
// The part of step k + 1 at the place y = k .. k + 1: by the width alpha, which is the root's square; its own
// square in the first step, where gains rise with the square of alpha.
#define LAYER_GRID_PART(y, k) (((y) * (y) - (k) * (k)) / (2.0f * (k) + 1.0f))

// 176 bytes, one for each material; its base colour is the material's diffuse term.
typedef struct Layers {
  float4 specular;              // a dielectric's tint, a metal's at its edge; w = metalness
  float4 coat;                  // colour of what lies below, seen through it straight on; w = weight
  float4 fuzz;                  // colour; w = weight
  float alpha_x, alpha_y, eta;  // widths along and across the tangent; index below over index above
  float film;                   // weight of the film
  float coat_alpha, coat_eta;   // the coat's width along the tangent; its index
  float fuzz_alpha;
  float metal;            // factor on a metal's reflection
  float matte_roughness;  // of the ground
  float matte_scale,
      matte_scale_bare;  // normalise T(wo) T(wi) of the layers above, and of the interface alone
  float glass;           // the share of a dielectric base that transmits
  float shine_scale;     // 1, or what keeps the base's facets from returning more than all light
  float turn_x, turn_y;  // the tangent's turn from the surface's first coordinate
  u32 first;             // of the rows
  float darkening;       // how much of the coat's inner reflections' darkening there is
  float inner;           // what the coat's inside sends back of light from the base
  float straight;        // what the base's interface reflects straight on
  u32 grid;              // its first number, or NO_LAYER_GRID
  // For textures of metalness or roughness:
  float roughness;          // a factor on the texture's
  float haze;               // twice the coat's roughness to the 4th power: what widens the base's facets
  float stretch, narrowed;  // the width along the tangent over that of round facets; across over along
  float inner_smooth, inner_matte;  // `inner` for a base that reflects as a mirror, and as a matte one
  float coat_alpha_y;               // of the coat's facets across the tangent
  u32 coat_gains;                   // of these: the first of LAYER_TURNS rows, or NO_LAYER_GAINS
  // For a texture of the coat's weight, without which coat_grid is NO_LAYER_GRID:
  u32 coat_grid;  // numbers from one step's grid by roughness to the next's; 0: one grid, by the weight
  float index, index_scale;  // the base's index, and the root of the factor on what that reflects straight on
  float coat_bends;          // how much the coat's index is above 1, where it bends light for the base
} Layers;
SUNDOG_SHARED_SIZE(Layers, 176)

SUNDOG_SHARED_END
#endif
