// One light of many for a point, by the tree over the lights with an extent: at each node a child is chosen
// by its power over the square of its distance (the idea of Conty Estevez and Kulla 2018, "Importance
// Sampling of Many Lights with Adaptive Tree Splitting", without directions).
#pragma once
#include "lib/core/lanes.h"
#include "lib/core/tables.h"

#if HAS_LIGHT_TREE
// How much the lights of a node may matter at p. Within reach of the box the distance says nothing.
static inline float node_importance(__global const LightNode* node, float3 p) {
  const float3 lower = (float3)(node->lower[0], node->lower[1], node->lower[2]),
               upper = (float3)(node->upper[0], node->upper[1], node->upper[2]);
  const float3 half_size = 0.5f * (upper - lower), to = 0.5f * (upper + lower) - p;
  return node->power / fmax(fmax(dot(to, to), dot(half_size, half_size)), 1e-30f);
}

// The part of the left one of two children.
static inline float left_share(const Scene* scene, u32 left, u32 right, float3 p) {
  const float a = node_importance(scene->light_nodes + left, p),
              b = node_importance(scene->light_nodes + right, p);
  return a + b > 0.0f && a + b < INFINITY ? a / (a + b) : 0.5f;
}

// A light by the number u in [0, 1), and the probability that it is chosen with.
static inline u32 choose_light(const Scene* scene, float3 p, float u, float* probability) {
  u32 node = 0, next = scene->light_nodes[0].next;
  float chance = 1.0f;
  while (!(next & LIGHT_LEAF)) {
    const float share = left_share(scene, node + 1u, next, p);
    const bool left = u < share;
    u = fmin(left ? u / share : (u - share) / (1.0f - share), 0x1.fffffep-1f);
    chance *= left ? share : 1.0f - share;
    node = left ? node + 1u : next;
    next = scene->light_nodes[node].next;
  }
  *probability = chance;
  return next & ~LIGHT_LEAF;
}

// The probability that choose_light() chooses the light of leaf `leaf` for p.
static inline float light_probability(const Scene* scene, u32 leaf, float3 p) {
  float probability = 1.0f;
  for (u32 node = 0; node != leaf;) {
    const u32 right = scene->light_nodes[node].next;
    const float share = left_share(scene, node + 1u, right, p);
    const bool left = leaf < right;
    node = left ? node + 1u : right;
    probability *= left ? share : 1.0f - share;
  }
  return probability;
}

// Chooses for the points of `lanes`, by a number a lane.
NEVER_INLINE MASK choose_lights(const Scene* scene, REAL3 p, REAL u, MASK lanes, REAL* probability) {
  MASK index = NO_LANES;
  *probability = (REAL)(1.0f);
  EACH_LANE(i, lanes) {
    float chance;
    MASK_LANE(index, i) = (int)choose_light(scene, get3(&p, i), REAL_LANE(u, i), &chance);
    REAL_LANE(*probability, i) = chance;
  }
  return index;
}
static inline REAL light_probabilities(const Scene* scene, u32 leaf, REAL3 p, MASK lanes) {
  REAL probability = (REAL)(1.0f);
  EACH_LANE(i, lanes) REAL_LANE(probability, i) = light_probability(scene, leaf, get3(&p, i));
  return probability;
}
#endif
