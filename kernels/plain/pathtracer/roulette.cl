// Russian roulette.
#include "plain/pathtracer/path_state.cl"

// Paths with at least this part of the light that they began with never end by chance. Others continue with
// it: those that remain would else bring much light each, seldom, which is more noise than their time is
// worth.
#define LEAST_WORTH (1.0f / 3.0f)

// Whether the path continues, by the numbers of `dimension`: then it stands for those that do not. What
// refraction took from the radiance comes back when the ray leaves the medium, and says nothing of its worth.
static inline bool survives(UNIFORM const Scene* scene, PathState* path, int dimension) {
  const float worth = spectrum_worth(path->throughput) * path->spread;
  if (path->depth < (int)scene->info->roulette_depth || !(worth < LEAST_WORTH)) return true;
  const float chance = worth * (1.0f / LEAST_WORTH);
  const Numbers u = numbers_at(&path->at, dimension, false, true);
  path->throughput *= 1.0f / real_max(chance, 1e-20f);
  return u.w < chance;
}
