// What a denoiser takes for a picture's features: the albedo and the normal of the surfaces that a pixel's
// samples see, through the same filter, lens and time, behind smooth glass and in mirrors. A pixel a lane.
#ifndef SUNDOG_LIB_FEATURES_CL
#define SUNDOG_LIB_FEATURES_CL
#include "lib/path/camera_samples.cl"
#include "lib/pathtracer/leave_surfaces.cl"
#include "lib/pathtracer/numbers.cl"

#define FEATURE_SAMPLES 64u     // of a pixel, at most
#define FEATURE_DEPTH 16        // surfaces on a way, at most
#define FEATURE_DENSITY 100.0f  // per steradian: lobes of directions as likely as these are followed, too

typedef struct Features {
  REAL3 albedo, normal;
} Features;

// One sample of each lane on its way.
typedef struct FeatureWalks {
  PathStates paths;
  REAL3 tint, first;  // what mirrors and glass have left; the first one's normal
  Features seen;
} FeatureWalks;

static inline FeatureWalks start_features(const Scene* scene, const LaneSamples* at, MASK lanes) {
  const REAL3 none = all3((float3)(0.0f));
  FeatureWalks f = {start_paths(scene, at, lanes), all3((float3)(1.0f)), none, {none, none}};
  return f;
}

static inline REAL3 at_most_one3(REAL3 a) {
  const REAL one = (REAL)(1.0f);
  return real3(real_min(a.x, one), real_min(a.y, one), real_min(a.z, one));
}

// What a sample ends at is its feature: a surface, or behind mirrors the sky, which has only their tint.
static inline void end_features(REAL3 albedo, REAL3 normal, MASK lanes, FeatureWalks* f) {
  f->seen.albedo = select3(f->seen.albedo, multiply3(f->tint, albedo), lanes);
  f->seen.normal = select3(f->seen.normal, normal, lanes);
}

// Takes the samples of `lanes` to the next surface. Returns those that it sends on in about one direction.
NEVER_INLINE MASK step_features(const Scene* scene, FeatureWalks* f, SceneRays* rays, MASK lanes,
                                bool coherent, u32* counts) {
  Encounters met;
  PathStates* paths = &f->paths;
  const MASK first = MASK_OF(paths->depth == 1);
  see_surfaces(scene, rays, lanes, first, coherent, &met, counts);
  forget_glow(rays);
  f->tint = select3(f->tint, multiply3(f->tint, met.absorbed), lanes);
  const MASK hit = lanes & hit_anything(&met.hit);
  end_features(all3((float3)(1.0f)), f->first, lanes & ~hit & ~first, f);
  if (!any_lane(hit)) return NO_LANES;
  Shading at;
  shade_hits(scene, rays, &met, hit, &at);
  follow_hero(&paths->wavelengths, &at.bsdf);
  const REAL3 wo = negate3(rays->d);
  const Lobes lobes = make_lobes(scene, &at.bsdf, wo, hit);
  const FourNumbers u = sample_lanes(&paths->at, dimension_here(paths, BOUNCE_DIRECTION));
  const BsdfSamples sample = sample_lobes(scene, &at.bsdf, &lobes, wo, u.z, u.x, u.y, hit);
  const MASK follows = hit & MASK_OF(paths->depth < FEATURE_DEPTH) &
                       (sample.specular | MASK_OF(sample.pdf > FEATURE_DENSITY)) &
                       MASK_OF(greatest3(sample.weight) > 0.0f);
  end_features(albedo_of(&at.bsdf), at.s.ns, hit & ~follows, f);
  f->first = select3(f->first, at.s.ns, follows & first);
  f->tint = select3(f->tint, at_most_one3(multiply3(f->tint, sample.weight)), follows);
  const MASK free = cut_away(&at.bsdf, &lobes.split, follows) & may_cross(rays);
  paths->depth -= follows & ~free;
  leave_surface(scene, &met, &at, &sample, MASK_OF(dot3(at.s.ng, sample.wi) < 0.0f) & follows, free & follows,
                rays, follows);
  return follows;
}

// The mean of the samples of the pixels (x, y) of `lanes`.
NEVER_INLINE Features mean_features(const Scene* scene, MediaStack around, MASK x, MASK y, MASK lanes,
                                    u32* counts) {
  const u32 samples = min(scene->info->samples, FEATURE_SAMPLES);
  const REAL3 none = all3((float3)(0.0f));
  Features sum = {none, none};
  REAL weights = (REAL)(0.0f);
  for (u32 k = 0; k < samples; ++k) {
    const BegunSamples begun = {{x, y, (MASK)((int)k), scene->info->seed}, lanes};
    float signs[BATCH];
    SceneRays rays = begun_rays(scene, &begun, samples, around, signs);
    FeatureWalks f = start_features(scene, &begun.at, lanes);
    bool coherent = true;
    for (MASK going = lanes; any_lane(going); coherent = false) {
      start_marching(counts);
      going = step_features(scene, &f, &rays, going, coherent, counts);
    }
    REAL sign = (REAL)(0.0f);
    for (u32 bits = lane_bits(lanes); bits; bits &= bits - 1u)
      REAL_LANE(sign, lowest_bit(bits)) = signs[lowest_bit(bits)];
    weights += sign;
    sum.albedo = along3(sum.albedo, sign, f.seen.albedo);
    sum.normal = along3(sum.normal, sign, f.seen.normal);
  }
  const REAL share = 1.0f / select((REAL)(1.0f), weights, MASK_OF(weights > 0.0f));
  sum.albedo = scale3(sum.albedo, share);
  sum.normal = scale3(sum.normal, share);
  const REAL zero = (REAL)(0.0f);
  sum.albedo = at_most_one3(
      real3(real_max(sum.albedo.x, zero), real_max(sum.albedo.y, zero), real_max(sum.albedo.z, zero)));
  return sum;
}

#endif
