// What plain text of the path tracer uses of what is written in lanes: of structs, the members that it reads
// or sets.
#include "plain/core.h"
#include "shared/sampler.h"
#include "shared/scene.h"

LANE_VECTOR(SampledSpectrum, SampledSpectrum, spectrum);  // a colour, or wavelengths

typedef struct LANES(SceneRays, join_rays) {
  float3 o, d;
  float t_min, t_max;
} SceneRay;
typedef struct LANES(BegunRays) {
  int unused;
} BegunRay;
typedef struct LANES(Hits) {
  int instance, prim;
} SurfaceHit;
typedef struct LANES(Faces) {
  int flags;
} Face;
typedef struct LANES(Encounters) {
  SurfaceHit hit;
  Face face;
  float3 absorbed;
} Encounter;
typedef struct LANES(SurfaceInteractions) {
  float3 p, ng, ns;
  float offset;
  int instance, material;
  bool entering;
} SurfaceInteraction;
typedef struct LANES(Bsdfs) {
  int flags;
} Bsdf;
typedef struct LANES(Shading) {
  SurfaceInteraction s;
  Bsdf bsdf;
} SurfaceShading;
typedef struct LANES(SpecularSplits) {
  float eta;
} SpecularSplit;
typedef struct LANES(Lobes) {
  SpecularSplit split;
  float matte, all;
} LobeSet;
typedef struct LANES(BsdfSamples) {
  float3 wi, weight;
  float pdf;
  bool specular;
} BsdfSample;
typedef struct LANES(LightSamples) {
  float3 wi, radiance;
  float distance, pdf;
  bool delta;
} LightSample;
typedef struct LANES(FourNumbers) {
  float x, y, z, w;
} Numbers;
typedef struct LANES(LaneSamples) {
  int sample;
} SampleAt;
typedef struct LANES(SampledWavelengths) {
  int unused;
} SampledWavelengths;
typedef struct LANES(PathStates, join_paths) {
  SampledSpectrum throughput, radiance;
  float3 from;
  float pdf, spread;
  int depth;
  bool covered, straight;
  SampleAt at;
  SampledWavelengths wavelengths;
} PathState;

// Random numbers.
int dimension_here(const PathState* path, UNIFORM u32 offset);
CALLED(wanted_lanes)
Numbers numbers_at(const SampleAt* at, int dimension, UNIFORM bool first, UNIFORM bool later);

// Spectra.
SampledSpectrum spectrum_of(const SampledWavelengths* w, float3 color);
SampledSpectrum spectrum_kept(const SampledWavelengths* w, float3 kept);
float spectrum_worth(SampledSpectrum a);
float spectrum_greatest(SampledSpectrum a);
void follow_hero(const SampledWavelengths* w, Bsdf* bsdf);
void keep_hero(UNIFORM const Scene* scene, const SurfaceShading* at, const SpecularSplit* split,
               const PathState* path, SampledSpectrum* light, HERE);
void part_wavelengths(UNIFORM const Scene* scene, const SurfaceShading* at, const SpecularSplit* split,
                      PathState* path, HERE, bool mirror);

// The way to the next interface.
BegunRay begun_rays_of(const SceneRay* ray);
bool meet_interfaces(UNIFORM const Scene* scene, SceneRay* ray, HERE, UNIFORM bool coherent, Encounter* met,
                     UNIFORM u32* counts);
bool pass_hidden(UNIFORM const Scene* scene, SceneRay* ray, const Encounter* met, HERE);
bool hit_anything(const SurfaceHit* hit);
bool may_cross(const SceneRay* ray);
float3 emitted(const SceneRay* ray);
void forget_glow(SceneRay* ray);
bool scatter_in_media(UNIFORM const Scene* scene, PathState* path, const BegunRay* begun, SceneRay* ray,
                      const Encounter* met, HERE, bool* going, UNIFORM u32* counts);

// Light that is met, and the chances that it was chosen with.
float area_light_pdf(UNIFORM __global const Light* light, float3 p, float3 wi, float distance);
float pdf_in_tree(UNIFORM const Scene* scene, const PathState* path, UNIFORM u32 index, float pdf, HERE);
float pdf_on_stretch(const PathState* path, UNIFORM __global const Light* light, float pdf);
float weight_of_met(UNIFORM const Scene* scene, const PathState* path, float chosen, HERE);
float3 left_by_photons(const PathState* path, float3 light, HERE);
float3 mapped_emission(const Bsdf* bsdf, float3 light);
float3 distant_along(UNIFORM const Scene* scene, float3 d, HERE, float* pdf);
float3 background_along(UNIFORM __global const SceneInfo* info, float3 d);
float3 hide_environment(UNIFORM const Scene* scene, float3 d, float3 light, bool camera);
UNIFORM bool sees_environment(UNIFORM const Scene* scene);
UNIFORM float sun_pdf(UNIFORM __global const Light* sun, UNIFORM float chance);
bool sees_sun(UNIFORM __global const Light* sun, float3 d, bool camera);
float clear_of_fog(UNIFORM const Scene* scene, const Encounter* met, HERE);
SampledSpectrum gather_photons(UNIFORM const Scene* scene, const PathState* path, const SceneRay* ray,
                               const SurfaceShading* at, const LobeSet* lobes, HERE);

// Surfaces.
void shade_hits(UNIFORM const Scene* scene, const SceneRay* ray, const Encounter* met, HERE,
                SurfaceShading* at);
LobeSet make_lobes(UNIFORM const Scene* scene, const Bsdf* bsdf, float3 wo, HERE);
bool scatters(const LobeSet* lobes);
bool cut_away(const Bsdf* bsdf, const SpecularSplit* split, HERE);
float3 bsdf_scatter(UNIFORM const Scene* scene, const Bsdf* bsdf, const LobeSet* lobes, float3 wo, float3 wi,
                    HERE, float* pdf);
float guided_pdf(UNIFORM const Scene* scene, const LobeSet* lobes, float3 p, float3 wi, float pdf, HERE);
BsdfSample sample_guided(UNIFORM const Scene* scene, const Bsdf* bsdf, const LobeSet* lobes, float3 p,
                         float3 wo, float u_term, float u_x, float u_y, HERE, float* spread);
float3 narrow_part(UNIFORM const Scene* scene, const Bsdf* bsdf, const LobeSet* lobes, float3 wo,
                   const BsdfSample* sample, HERE);
float terminator(const SurfaceInteraction* s, float3 wi);
void leave_stretch(PathState* path, HERE);
void note_gathered(PathState* path, bool specular, float3 narrow, HERE);

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
void leave_surface(UNIFORM const Scene* scene, const Encounter* met, const SurfaceShading* at,
                   const BsdfSample* sample, bool below, bool free, SceneRay* ray, HERE);

// Lights that are chosen.
LightSample choose_one(UNIFORM const Scene* scene, float3 p, const Numbers* u, HERE, bool* seen);
float weight_of_chosen(UNIFORM const Scene* scene, float chosen, float scattered, HERE);
float relief_visibility(UNIFORM const Scene* scene, const SurfaceInteraction* s, float3 wi, HERE);
float walls_visibility(UNIFORM const Scene* scene, const SceneRay* ray, const SurfaceInteraction* s,
                       float3 wi, HERE, UNIFORM u32* counts);
SceneRay ray_to_light(UNIFORM const Scene* scene, const SceneRay* ray, const Encounter* met,
                      const SurfaceShading* at, const LightSample* light, bool below, HERE);
SampledSpectrum arriving_spectrum(UNIFORM const Scene* scene, const SampledWavelengths* w, SceneRay* ray,
                                  SampledSpectrum light, HERE, UNIFORM u32* counts);
