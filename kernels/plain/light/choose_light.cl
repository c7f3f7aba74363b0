// Chooses one area light of many for a point, by the tree over them: at each node a child, by its power over
// the square of its distance (the idea of Conty Estevez and Kulla 2018, "Importance Sampling of Many Lights
// with Adaptive Tree Splitting", without directions).
#include "plain/core.h"

HAVING(HAS_LIGHT_TREE);

// How much the lights of a node may matter at p. Within reach of the box the distance says nothing.
static inline float node_importance(UNIFORM const Scene* scene, u32 number, float3 p) {
  __global const LightNode* node = scene->light_nodes + number;
  const float3 lower = (float3)(node->lower[0], node->lower[1], node->lower[2]);
  const float3 upper = (float3)(node->upper[0], node->upper[1], node->upper[2]);
  const float3 half_size = 0.5f * (upper - lower), to = 0.5f * (upper + lower) - p;
  return node->power / fmax(fmax(plain_dot(to, to), plain_dot(half_size, half_size)), 1e-30f);
}

// The part of the left one of two children.
static inline float left_share(UNIFORM const Scene* scene, u32 left, u32 right, float3 p) {
  const float a = node_importance(scene, left, p), b = node_importance(scene, right, p);
  return a + b > 0.0f && a + b < INFINITY ? a / (a + b) : 0.5f;
}

// A light by the number u in [0, 1), and the probability that it is chosen with.
ENTRY static int choose_light(UNIFORM const Scene* scene, float3 p, float u, OUT float* probability) {
  u32 node = 0u, next = scene->light_nodes[0].next;
  float chance = 1.0f, number = u;
  while ((next & LIGHT_LEAF) == 0u) {
    const float share = left_share(scene, node + 1u, next, p);
    const bool left = number < share;
    number = fmin(left ? number / share : (number - share) / (1.0f - share), 0x1.fffffep-1f);
    chance *= left ? share : 1.0f - share;
    node = left ? node + 1u : next;
    next = scene->light_nodes[node].next;
  }
  *probability = chance;
  return (int)(next & ~LIGHT_LEAF);
}

// The probability that choose_light() chooses the light of leaf `leaf` for p.
ENTRY static inline float light_probability(UNIFORM const Scene* scene, UNIFORM u32 leaf, float3 p) {
  float probability = 1.0f;
  for (u32 node = 0u; node != leaf;) {
    const u32 right = scene->light_nodes[node].next;
    const float share = left_share(scene, node + 1u, right, p);
    const bool left = leaf < right;
    node = left ? node + 1u : right;
    probability *= left ? share : 1.0f - share;
  }
  return probability;
}
