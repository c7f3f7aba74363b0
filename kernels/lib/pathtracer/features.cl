// The mean of the features of a pixel's samples (plain/pathtracer/features.cl). A pixel a lane.
#pragma once
#include "lib/path/camera_samples.cl"
#include "lib/pathtracer/steps.cl"
#include "plain/pathtracer/features.cl"

#define FEATURE_SAMPLES 64u  // of a pixel, at most

typedef struct Features {
  REAL3 albedo, normal;
} Features;

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
    FeatureWalks f = start_feature(scene, &begun.at, lanes);
    bool coherent = true;
    for (MASK going = lanes; any_lane(going); coherent = false) {
      start_marching(counts);
      going = going & step_feature(scene, &f, &rays, coherent, counts, going);
    }
    REAL sign = (REAL)(0.0f);
    EACH_LANE(i, lanes) REAL_LANE(sign, i) = signs[i];
    weights += sign;
    sum.albedo = along3(sum.albedo, sign, f.albedo);
    sum.normal = along3(sum.normal, sign, f.normal);
  }
  const REAL share = 1.0f / select((REAL)(1.0f), weights, MASK_OF(weights > 0.0f));
  sum.albedo = scale3(sum.albedo, share);
  sum.normal = scale3(sum.normal, share);
  const REAL zero = (REAL)(0.0f);
  sum.albedo = at_most_one(
      real3(real_max(sum.albedo.x, zero), real_max(sum.albedo.y, zero), real_max(sum.albedo.z, zero)), lanes);
  return sum;
}
