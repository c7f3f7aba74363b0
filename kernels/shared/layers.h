// Layered materials, from the top: fuzz, a coat, a film, and a base (a metal, or a dielectric over a diffuse
// ground), in the terms of OpenPBR 1.1 (host/models/values/openpbr.h has names and ranges).
#pragma once
#include "shared/types.h"
SUNDOG_SHARED_BEGIN

// Rows of a material in the table layer_rows, each by the cosine to the normal from 0 to 1: the fraction of
// light that fuzz, coat and the base's interface transmit to the layers below; RGB reflectance of a film on a
// dielectric and on a metal; and gains of the base's facets.
#define LAYER_STEPS 32u
#define LAYER_FUZZ 0u
#define LAYER_COAT 1u
#define LAYER_SHINE 2u
#define LAYER_FILM 3u
#define LAYER_FILM_METAL 6u
#define LAYER_GAINS 9u  // of the base's facets: LAYER_TURNS rows by the squared component along the tangent
#define LAYER_TURNS 8u
#define LAYER_ROWS (LAYER_GAINS + LAYER_TURNS)

// An anisotropic coat has its own gains; isotropic ones share a row.
#define NO_LAYER_GAINS 0xFFFFFFFFu

// Narrower lobes are widened to this, so mirrors are lobes too.
#define LEAST_LAYER_ALPHA 1e-3f

// If a texture sets the base's roughness, dependent values form a grid in layer_rows by the square root of
// the mean width (specular_roughness without a coat) from 0 to 1: first these numbers of each step, then each
// step's row LAYER_SHINE and gains: one row for isotropic facets, else LAYER_TURNS.
#define LAYER_GRID_STEPS 16u
#define LAYER_GRID_STRAIGHT 0u  // as the members of Layers
#define LAYER_GRID_SHINE_SCALE 1u
#define LAYER_GRID_MATTE_SCALE 2u
#define LAYER_GRID_MATTE_SCALE_BARE 3u
#define LAYER_GRID_NUMBERS 4u
#define NO_LAYER_GRID 0xFFFFFFFFu
// If a texture sets the coat's weight, steps are over that, and exact at each for all that depends on it,
// including the base's widths and its index under the coat. If textures set both, there is a grid by
// roughness for each step of the coat's weight. A film's rows then follow the material's own, LAYER_FILM_ROWS
// for each step of the coat's weight.
#define LAYER_FILM_ROWS (LAYER_GAINS - LAYER_FILM)
// The interpolation weight of step k + 1 at y = k .. k + 1: linear in the width alpha, which goes with y^2;
// squared in the first step, where gains rise with alpha^2.
#define LAYER_GRID_PART(y, k) (((y) * (y) - (k) * (k)) / (2.0f * (k) + 1.0f))

// 176 bytes, one per material; its base colour is the material's diffuse term.
typedef struct Layers {
  float4 specular;              // a dielectric's tint, a metal's edge tint; w = metalness
  float4 coat;                  // tint of what lies below at normal incidence; w = weight
  float4 fuzz;                  // colour; w = weight
  float alpha_x, alpha_y, eta;  // widths along and across the tangent; index below over above
  float film;                   // weight of the film
  float coat_alpha, coat_eta;   // the coat's width along the tangent; its index
  float fuzz_alpha;
  float metal;            // factor on a metal's reflection
  float matte_roughness;  // of the diffuse ground
  float matte_scale,
      matte_scale_bare;  // normalise T(wo) T(wi) of the layers above, and of the interface alone
  float glass;           // fraction of a dielectric base that transmits
  float shine_scale;     // at most 1; keeps the base's facets from reflecting more than all light
  float turn_x, turn_y;  // rotation of the tangent from the surface's first coordinate
  u32 first;             // of the rows
  float darkening;       // strength of the darkening by inner reflections of the coat
  float inner;           // internal reflectance of the coat for light from the base
  float straight;        // normal reflectance of the base's interface
  u32 grid;              // its first entry, or NO_LAYER_GRID
  // For textures of metalness or roughness:
  float roughness;                  // factor on the texture's
  float haze;                       // twice the coat's roughness to the 4th power: widens the base's facets
  float stretch, narrowed;          // width along the tangent relative to isotropic facets; across over along
  float inner_smooth, inner_matte;  // `inner` for a mirror base, and for a diffuse one
  float coat_alpha_y;               // width of the coat's facets across the tangent
  u32 coat_gains;  // gains of the coat's facets: the first of LAYER_TURNS rows, or NO_LAYER_GAINS
  // For a texture of the coat's weight; otherwise coat_grid is NO_LAYER_GRID:
  u32 coat_grid;             // entries from one step's grid by roughness to the next; 0: one grid, by weight
  float index, index_scale;  // the base's index, and the square root of the factor on its normal reflectance
  float coat_bends;          // the coat's index minus 1, if the coat refracts
} Layers;
SUNDOG_SHARED_SIZE(Layers, 176)

SUNDOG_SHARED_END
