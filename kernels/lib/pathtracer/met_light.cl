// What the tree of lights makes of the chances of lights that rays meet (plain/pathtracer/met_light.cl).
#ifndef SUNDOG_LIB_MET_LIGHT_CL
#define SUNDOG_LIB_MET_LIGHT_CL
#include "lib/pathtracer/path_state.cl"

#if HAS_AREA_LIGHTS
// What the choice by the tree, from the surfaces paths->from, makes of the density of the light `index`.
#if HAS_LIGHT_TREE
static inline REAL pdf_in_tree(const Scene* scene, const PathStates* paths, u32 index, REAL pdf, MASK lanes) {
  REAL chosen = pdf;
  const REAL3 from = chosen_from(paths);
  for (u32 bits = lane_bits(lanes); bits; bits &= bits - 1u) {
    const u32 i = lowest_bit(bits);
    REAL_LANE(chosen, i) *= light_probability(scene, scene->light_leaves[index], get3(&from, i));
  }
  return chosen;
}
#else
static inline REAL pdf_in_tree(const Scene* scene, const PathStates* paths, u32 index, REAL pdf, MASK lanes) {
  return pdf;
}
#endif

#endif
#endif
