// Russian roulette.
#include "plain/pathtracer/path_state.cl"

// Paths with at least this part of the light that they began with never end by chance. Others continue with
// it: those that remain would else bring much light each, seldom, which is more noise than their time is
// worth.
#define LEAST_WORTH (1.0f / 3.0f)

// Whether the path continues, by the number u in [0, 1): then it stands for those that do not. What
// refraction took from the radiance comes back when the ray leaves the medium, and says nothing of its worth.
static inline bool survives(UNIFORM const Scene* scene, PathState* path, float u) {
  const float worth = spectrum_worth(path->throughput) * path->spread;
  if (path->depth < (int)scene->info->roulette_depth || !(worth < LEAST_WORTH)) return true;
  const float chance = worth * (1.0f / LEAST_WORTH);
  path->throughput *= 1.0f / real_max(chance, 1e-20f);
  return u < chance;
}
