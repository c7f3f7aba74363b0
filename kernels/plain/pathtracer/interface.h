// What plain text of the path tracer uses of what is written in lanes: of structs, the members that it reads
// or sets.
#include "plain/core.h"
#include "plain/light/light_sample.cl"

typedef struct LANES(SceneRays, join_rays) {
  float3 o, d;
  float t_min, t_max, since;
  int media_low, media_high, crossings;
} SceneRay;
typedef struct LANES(Hits) {
  float t;
  int instance, prim;
} SurfaceHit;
typedef struct LANES(Faces) {
  int flags;
} Face;
typedef struct LANES(Encounters) {
  SurfaceHit hit;
  Face face;
  int before, after;
  float3 absorbed;
} Encounter;
typedef struct LANES(SurfaceInteractions) {
  float3 p, ng, ns;
  float offset;
  int instance, material;
  bool entering;
} SurfaceInteraction;
typedef struct LANES(Bsdfs) {
  float3 ng, ns;
  int flags, before, after;
} Bsdf;
typedef struct LANES(Shading) {
  SurfaceInteraction s;
  Bsdf bsdf;
} SurfaceShading;
typedef struct LANES(SpecularSplits) {
  bool transmits;
  float eta, f, cos_i;
} SpecularSplit;
typedef struct LANES(Lobes) {
  SpecularSplit split;
  float mirror, through, matte, all;
} LobeSet;
typedef struct LANES(WideLobes) {
  Bsdf bsdf;
  LobeSet lobes;
} WideLobeSet;
typedef struct LANES(BsdfSamples) {
  float3 wi, weight;
  float pdf;
  bool specular;
} BsdfSample;
typedef struct LANES(PhotonSearches) {
  float area;
} PhotonSearch;

// The way to the next interface.
bool meet_interfaces(UNIFORM const Scene* scene, SceneRay* ray, HERE, UNIFORM bool coherent, Encounter* met,
                     UNIFORM u32* counts);
bool pass_hidden(UNIFORM const Scene* scene, SceneRay* ray, const Encounter* met, HERE);
CALLED(no_hits) SurfaceHit hit_nothing(float t_max);
bool hit_anything(const SurfaceHit* hit);
bool may_cross(const SceneRay* ray);
float3 emitted(const SceneRay* ray);
void forget_glow(SceneRay* ray);

// Lights.
UNIFORM bool has_place(UNIFORM __global const Light* light);
UNIFORM float4 middle_of_light(UNIFORM __global const Light* light);
UNIFORM bool rays_meet(UNIFORM const Scene* scene, UNIFORM u32 index);
LightSample sample_light(UNIFORM const Scene* scene, UNIFORM u32 index, float3 p, float u_x, float u_y, HERE);
int choose_lights(UNIFORM const Scene* scene, float3 p, float u, HERE, float* probability);
float light_probabilities(UNIFORM const Scene* scene, UNIFORM u32 leaf, float3 p, HERE);
float area_light_pdf(UNIFORM __global const Light* light, float3 p, float3 wi, float distance);
float3 light_arriving(UNIFORM const Scene* scene, SceneRay* ray, float3 light, HERE, UNIFORM u32* counts);
float3 mapped_emission(const Bsdf* bsdf, float3 light);
float3 distant_along(UNIFORM const Scene* scene, float3 d, HERE, float* pdf);
float3 background_along(UNIFORM __global const SceneInfo* info, float3 d);
float3 hide_environment(UNIFORM const Scene* scene, float3 d, float3 light, bool camera);
UNIFORM bool sees_environment(UNIFORM const Scene* scene);
UNIFORM float sun_pdf(UNIFORM __global const Light* sun, UNIFORM float chance);
bool sees_sun(UNIFORM __global const Light* sun, float3 d, bool camera);
float clear_of_fog(UNIFORM const Scene* scene, const Encounter* met, HERE);

// Surfaces.
void shade_hits(UNIFORM const Scene* scene, const SceneRay* ray, const Encounter* met, HERE,
                SurfaceShading* at);
LobeSet make_lobes(UNIFORM const Scene* scene, const Bsdf* bsdf, float3 wo, HERE);
bool scatters(const LobeSet* lobes);
bool matte_layers(const LobeSet* lobes);
bool cut_away(const Bsdf* bsdf, const SpecularSplit* split, HERE);
float3 bsdf_scatter(UNIFORM const Scene* scene, const Bsdf* bsdf, const LobeSet* lobes, float3 wo, float3 wi,
                    HERE, float* pdf);
BsdfSample sample_lobes(UNIFORM const Scene* scene, const Bsdf* bsdf, const LobeSet* lobes, float3 wo,
                        float u_term, float u_x, float u_y, HERE);
WideLobeSet wide_lobes(const Bsdf* bsdf, const LobeSet* lobes);
float3 narrow_part(UNIFORM const Scene* scene, const Bsdf* bsdf, const LobeSet* lobes, float3 wo,
                   const BsdfSample* sample, HERE);
float terminator(const SurfaceInteraction* s, float3 wi);
float relief_visibility(UNIFORM const Scene* scene, const SurfaceInteraction* s, float3 wi, HERE);
float walls_visibility(UNIFORM const Scene* scene, const SceneRay* ray, const SurfaceInteraction* s,
                       float3 wi, HERE, UNIFORM u32* counts);

// Wavelengths at surfaces.
void set_wavelength_row(Bsdf* bsdf, float row);
bool disperses(UNIFORM const Scene* scene, int before, int after, HERE);
float relative_index_at(UNIFORM const Scene* scene, int before, int after, float row, HERE);
float refracted_cosine(float cos_i, float eta);
float fresnel_reflectance(float cos_i, float cos_t, float eta);

// Photons about a surface, one after the other.
PhotonSearch search_photons(UNIFORM const Scene* scene, const SampleAt* at, int depth, const SceneRay* ray,
                            const SurfaceInteraction* s, HERE);
bool next_photon(UNIFORM const Scene* scene, PhotonSearch* search, HERE, float3* wi, float3* flux);

// Rays that leave surfaces.
void start_on_surfaces(UNIFORM __global const SceneInfo* info, SceneRay* ray, const SurfaceHit* hit,
                       bool inside, HERE);
void start_on_hits(UNIFORM __global const SceneInfo* info, SceneRay* ray, const SurfaceHit* hit, bool inside,
                   HERE);
float3 leave_relief(const SurfaceInteraction* s, float3 wi, float* way);
float3 leaving_normal(const SurfaceInteraction* s);
float3 points_behind(UNIFORM const Scene* scene, const SurfaceInteraction* s, float3 d, HERE);
void enter_behind(const Encounter* met, const SceneRay* ray, HERE, SceneRay* child);
void cross_further(const SceneRay* before, HERE, SceneRay* ray);
