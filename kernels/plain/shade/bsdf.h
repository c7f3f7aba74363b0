// The terms that a surface gets from its material, with checkerboard, textures and the deciding wavelength.
#include "plain/shade/interface.h"

typedef struct Bsdf {
  float3 side, ns;                   // unit, both on the viewer's side: SurfaceInteractions
  float3 ambient, diffuse;           // ka and kd, with pattern and colour
  int material, flags;               // index; of the material
  int before, after;                 // media on the viewer's side and behind
  HAVING(HAS_DISPERSION) float row;  // of the wavelength that decides the ray's direction, in `spectra`
  HAVING(HAS_MAPS) float3 specular, reflection, transmission;  // with textures
  HAVING(HAS_MAPS) float3 emission;                            // factor on the material's
  HAVING(HAS_MAPS) float exponent;
  HAVING(HAS_LAYERS) float3 base;                // colour of layered materials, whose diffuse term is 0
  HAVING(HAS_LAYERS) float3 tangent, bitangent;  // unit, orthogonal to ns
  HAVING(HAS_OPACITY) float there;               // opacity
  HAVING(HAS_LAYERS) bool coated;                // fuzz and coat are on the viewer's side
  HAVING(HAS_LAYERS) bool coated_behind;         // on the other side
  HAVING(HAS_LAYER_MAPS) float metalness, roughness, glass;  // of layered materials, with textures
  HAVING(HAS_COAT_MAPS) float coat;                          // factor on the coat's weight
  HAVING(HAS_FUZZ_MAPS) float3 fuzz;                         // factor on the fuzz's color
  HAVING(HAS_SPECULAR_MAPS) float3 tint;                     // factor on the reflectance of the dielectric
} Bsdf;

// A surface that a ray has met, and what it does to light.
typedef struct SurfaceShading {
  SurfaceInteraction s;
  Bsdf bsdf;
} SurfaceShading;
