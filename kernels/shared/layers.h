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

// Narrower lobes are widened to this: mirrors are lobes too.
#define LEAST_LAYER_ALPHA 1e-3f

// 128 bytes, one for each material; its base colour is the material's diffuse term.
typedef struct Layers {
  float4 specular;              // a dielectric's tint, a metal's at its edge; w = metalness
  float4 coat;                  // colour of what lies below, seen through it straight on; w = weight
  float4 fuzz;                  // colour; w = weight
  float alpha_x, alpha_y, eta;  // widths along and across the tangent; index below over index above
  float film;                   // weight of the film
  float coat_alpha, coat_eta;
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
  float unused;
} Layers;
SUNDOG_SHARED_SIZE(Layers, 128)

SUNDOG_SHARED_END
#endif
