// Facets of a surface for a viewer (lobes/ggx.cl).
#include "plain/shade/facets.cl"

typedef struct FurtherLight {
  float lost;               // m(wo), also the share of the samples
  float through;            // fraction transmitted
  float mean, mean_behind;  // of m on the viewer's side and behind
} FurtherLight;

typedef struct Microfacet {
  bool rough, bends;  // has facets; they also refract
  bool transmits;     // they refract, or are those of a frosted wall
  bool mends;         // the lobe is scaled by gains: microfacet_gain()
  bool glass;         // refracting dielectrics with a separate multiple-scattering lobe
  float alpha, lambda_o;
  float gain;                           // of the viewer's side
  HAVING(HAS_THIN_WALLS) bool frosted;  // thin walls with transmitting facets
  HAVING(HAS_ROUGH_GLASS) FurtherLight further;
} Microfacet;
