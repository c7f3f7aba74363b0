// The terms that surfaces get from their materials, with checkerboard, textures and the deciding wavelength.
// One surface per lane.
#ifndef SUNDOG_LIB_BSDF_TERMS_CL
#define SUNDOG_LIB_BSDF_TERMS_CL
#include "lib/path/media.cl"
#include "lib/shade/dispersion.cl"
#include "lib/shade/interaction.cl"
#include "lib/shade/maps.cl"
#include "shared/layers.h"

typedef struct Bsdfs {
  REAL3 ng, ns;            // unit, both on the viewer's side
  REAL3 ambient, diffuse;  // ka and kd, with pattern and colour
  MASK material, flags;    // index; of the material
  MASK before, after;      // media on the viewer's side and behind
#if HAS_DISPERSION
  REAL row;  // of the wavelength that decides the ray's direction, in the table `spectra`
#endif
#if HAS_MAPS
  REAL3 specular, reflection, transmission;  // with textures
  REAL3 emission;                            // factor on the material's
  REAL exponent;
#endif
#if HAS_LAYERS
  REAL3 base;                // colour of layered materials, whose diffuse term is 0
  REAL3 tangent, bitangent;  // unit, orthogonal to ns
  REAL there;                // opacity
  MASK coated;               // fuzz and coat are on the viewer's side
  MASK coated_behind;        // on the other side
#endif
#if HAS_LAYER_MAPS
  REAL metalness, roughness, glass;  // of layered materials, with textures
#endif
#if HAS_COAT_MAPS
  REAL coat;  // factor on a layered material's coat weight
#endif
#if HAS_FUZZ_MAPS
  REAL3 fuzz;  // factor on a layered material's fuzz color
#endif
#if HAS_SPECULAR_MAPS
  REAL3 tint;  // factor on the reflectance of a layered material's dielectric
#endif
} Bsdfs;

// Emission multiplied by its texture.
#if HAS_MAPS
static inline REAL3 mapped_emission(const Bsdfs* bsdf, REAL3 light) {
  return multiply3(light, bsdf->emission);
}
#else
static inline REAL3 mapped_emission(const Bsdfs* bsdf, REAL3 light) { return light; }
#endif

// Sets the wavelength that decides the ray's direction, as a row of the table `spectra`; relative index of
// the surfaces of `lanes`, behind over before, at that wavelength.
#if HAS_DISPERSION
static inline void set_wavelength_row(Bsdfs* bsdf, REAL row) { bsdf->row = row; }
static inline REAL index_behind(const Scene* scene, const Bsdfs* bsdf, MASK lanes) {
  return relative_index_at(scene, bsdf->before, bsdf->after, bsdf->row, lanes);
}
#else
static inline void set_wavelength_row(Bsdfs* bsdf, REAL row) {}
static inline REAL index_behind(const Scene* scene, const Bsdfs* bsdf, MASK lanes) {
  return relative_index(scene->media, bsdf->before, bsdf->after, lanes);
}
#endif

// The checkerboard of `lanes`, all of one material. It is fixed in the instance's space, and filtered by the
// footprint of a camera ray of the same length, so that kernels without cones draw the same.
#if HAS_CHECKER
static inline void add_checker(const Scene* scene, __global const Material* material,
                               const SurfaceInteractions* s, MASK lanes, Bsdfs* bsdf) {
  const float frequency = material->checker_diffuse.w;
  u32 index;
  for (u32 left = lane_bits(lanes); left;) {
    const MASK mine = take_alike(s->instance, &left, &index);
    const float4 scale = scene->instances[index].pattern_scale;
    const REAL3 q = scale3(multiply3(points_of(scene, index, s, s->p), all3(scale.xyz)), (REAL)(frequency));
    const REAL3 n = safe_unit3(multiply3(vectors_of(scene, index, s, s->ng), all3(scale.xyz)));
    const REAL width = s->camera_footprint * (frequency * scale.w) / moved_size(scene, index, time_of(s));
    const REAL odd = checker_pattern(q, scale3(sines_to_axes(n), width)), even = 1.0f - odd;
    bsdf->ambient = select3(
        bsdf->ambient, along3(scale3(bsdf->ambient, even), odd, all3(material->checker_ambient.xyz)), mine);
    bsdf->diffuse = select3(
        bsdf->diffuse, along3(scale3(bsdf->diffuse, even), odd, all3(material->checker_diffuse.xyz)), mine);
  }
}
#else
static inline void add_checker(const Scene* scene, __global const Material* material,
                               const SurfaceInteractions* s, MASK lanes, Bsdfs* bsdf) {}
#endif

// Applies textures to the terms of `lanes`.
#if HAS_MAPS
#if HAS_LAYERS
static inline void keep_opacity(const Terms* terms, Bsdfs* bsdf) { bsdf->there = terms->there; }
#else
static inline void keep_opacity(const Terms* terms, Bsdfs* bsdf) {}
#endif
#if HAS_LAYER_MAPS
static inline void start_base(const Scene* scene, u32 material, MASK lanes, Terms* terms) {
  if (!(scene->materials[material].flags & MATERIAL_LAYERED)) return;
  __global const Layers* layers = scene->layers + material;
  terms->metalness = select(terms->metalness, (REAL)(layers->specular.w), lanes);
  terms->roughness = select(terms->roughness, (REAL)(layers->roughness), lanes);
  terms->glass = select(terms->glass, (REAL)(layers->glass), lanes);
}
static inline void keep_base(const Terms* terms, Bsdfs* bsdf) {
  bsdf->metalness = terms->metalness;
  bsdf->roughness = terms->roughness;
  bsdf->glass = terms->glass;
}
#else
static inline void start_base(const Scene* scene, u32 material, MASK lanes, Terms* terms) {}
static inline void keep_base(const Terms* terms, Bsdfs* bsdf) {}
#endif
#if HAS_COAT_MAPS
static inline void keep_coat(const Terms* terms, Bsdfs* bsdf) { bsdf->coat = terms->coat; }
#else
static inline void keep_coat(const Terms* terms, Bsdfs* bsdf) {}
#endif
#if HAS_SPECULAR_MAPS
static inline void keep_tint(const Terms* terms, Bsdfs* bsdf) { bsdf->tint = terms->tint; }
#else
static inline void keep_tint(const Terms* terms, Bsdfs* bsdf) {}
#endif
#if HAS_FUZZ_MAPS
static inline void keep_fuzz(const Terms* terms, Bsdfs* bsdf) { bsdf->fuzz = terms->fuzz; }
#else
static inline void keep_fuzz(const Terms* terms, Bsdfs* bsdf) {}
#endif
static inline void add_maps(const Scene* scene, const SurfaceInteractions* s, MASK lanes, Bsdfs* bsdf) {
  Terms terms = start_terms(bsdf->ambient, bsdf->diffuse);
  MASK mapped = NO_LANES;
  u32 index;
  for (u32 left = lane_bits(lanes); left;) {
    const MASK mine = take_alike(s->material, &left, &index);
    __global const Material* material = scene->materials + index;
    terms.specular = select3(terms.specular, all3(material->specular.xyz), mine);
    terms.reflection = select3(terms.reflection, all3(material->reflection.xyz), mine);
    terms.transmission = select3(terms.transmission, all3(material->transmission.xyz), mine);
    terms.exponent = select(terms.exponent, (REAL)(material->specular.w), mine);
    start_base(scene, index, mine, &terms);
    if (material->maps != NO_MAPS) mapped |= mine;
  }
  if (any_lane(mapped)) map_terms(scene, s, mapped, &terms);
  even_highlights(s, &terms);
  bsdf->ambient = terms.ambient;
  bsdf->diffuse = terms.diffuse;
  bsdf->specular = terms.specular;
  bsdf->reflection = terms.reflection;
  bsdf->transmission = terms.transmission;
  bsdf->emission = terms.emission;
  bsdf->exponent = terms.exponent;
  keep_opacity(&terms, bsdf);
  keep_base(&terms, bsdf);
  keep_coat(&terms, bsdf);
  keep_tint(&terms, bsdf);
  keep_fuzz(&terms, bsdf);
}
#else
static inline void add_maps(const Scene* scene, const SurfaceInteractions* s, MASK lanes, Bsdfs* bsdf) {}
#endif

#endif
