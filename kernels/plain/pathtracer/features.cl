// The features that a denoiser reads: the albedo and the normal of the surface that a sample
// sees, through the same filter, lens and time, behind smooth glass and in mirrors.
#include "plain/path/lens.cl"
#include "plain/pathtracer/hero.cl"
#include "plain/pathtracer/leave_surface.cl"

#define FEATURE_DEPTH 16        // surfaces on a way, at most
#define FEATURE_SAMPLES 64u     // of a pixel, at most
#define FEATURE_DENSITY 100.0f  // per steradian: lobes of directions as likely as these are followed, too

void start_marching(UNIFORM u32* counts);

// A sample on its way.
typedef struct FeatureWalk {
  PathState path;
  float3 tint, first;  // what mirrors and glass have left; the first one's normal
  float3 albedo, normal;
} FeatureWalk;

static inline float3 at_most_one(float3 a) {
  return (float3)(real_min(a.x, 1.0f), real_min(a.y, 1.0f), real_min(a.z, 1.0f));
}

// Takes the sample to the next surface. Returns whether that sends it on in about one direction. Else it is
// the sample's feature, or behind mirrors the sky, which has only their tint.
static bool step_feature(UNIFORM const Scene* scene, FeatureWalk* f, SceneRay* ray, UNIFORM bool coherent,
                         UNIFORM u32* counts) {
  Encounter met;
  const bool first = f->path.depth == 1;
  see_surfaces(scene, ray, first, coherent, &met, counts);
  forget_glow(ray);
  f->tint *= met.absorbed;
  if (!hit_anything(&met.hit)) {
    if (!first) {
      f->albedo = f->tint;
      f->normal = f->first;
    }
    return false;
  }
  SurfaceShading at;
  shade_hit(scene, ray, &met, &at);
  follow_hero(&f->path.wavelengths, &at.bsdf);
  if (HAS_CATCHERS && first && (at.bsdf.flags & (int)MATERIAL_CATCHER) != 0 && may_cross(ray)) {
    pass_straight(scene, &met, &at, ray);
    return true;
  }
  const LobeSet lobes = make_lobes(scene, &at.bsdf, -ray->d);
  const Numbers u = numbers_at(&f->path.at, dimension_here(f->path.depth, BOUNCE_DIRECTION), true, true);
  const BsdfSample sample = sample_lobes(scene, &at.bsdf, &lobes, -ray->d, u.z, u.x, u.y);
  const bool narrow = sample.specular || sample.pdf > FEATURE_DENSITY;
  if (!(narrow && f->path.depth < FEATURE_DEPTH && greatest(sample.weight) > 0.0f)) {
    f->albedo = f->tint * scattered_albedo(scene, &at.bsdf, &lobes, -ray->d);
    f->normal = at.s.ns;
    return false;
  }
  if (first) f->first = at.s.ns;
  f->tint = at_most_one(f->tint * sample.weight);
  const bool cut_out = cut_away(&at.bsdf, &lobes.interface) && may_cross(ray);
  if (!cut_out) ++f->path.depth;
  leave_surface(scene, &met, &at, &sample, dot(at.s.side, sample.wi) < 0.0f, cut_out, ray);
  return true;
}

// The mean albedo of the samples of the pixel of `at`; `normal`: likewise.
ENTRY static float3 mean_features(UNIFORM const Scene* scene, UNIFORM const MediaStack* around,
                                  const SampleAt* at, OUT float3* normal, UNIFORM u32* counts) {
  const float3 none = (float3)(0.0f);
  const u32 samples = min(scene->info->samples, FEATURE_SAMPLES);
  float3 albedo = none, n = none;
  float weights = 0.0f;
  for (u32 k = 0u; k < samples; ++k) {
    SampleAt here = *at;
    here.sample = (int)k;
    float sign;
    SceneRay ray = sample_ray(scene, &here, samples, around, &sign);
    FeatureWalk f = {start_path(scene, &here), (float3)(1.0f), none, none, none};
    start_marching(counts);
    bool going = step_feature(scene, &f, &ray, true, counts);
    while (going) {
      start_marching(counts);
      going = step_feature(scene, &f, &ray, false, counts);
    }
    weights += sign;
    albedo = along(albedo, sign, f.albedo);
    n = along(n, sign, f.normal);
  }
  const float share = 1.0f / (weights > 0.0f ? weights : 1.0f);
  *normal = n * share;
  albedo = albedo * share;
  return at_most_one((float3)(real_max(albedo.x, 0.0f), real_max(albedo.y, 0.0f), real_max(albedo.z, 0.0f)));
}
