// Where lights are, and how photons leave them.
#include "plain/light/lights/"

ENTRY static inline UNIFORM bool has_place(UNIFORM __global const Light* light) {
  return (PLACED_LIGHTS >> light->kind & 1u) != 0u;
}

// Whether two numbers choose the way to it.
ENTRY static inline UNIFORM bool has_extent(UNIFORM __global const Light* light) {
  return (LIGHTS_WITHOUT_EXTENT >> light->kind & 1u) == 0u;
}

// The middle of a light; w: the square of its size. Shorter distances to the middle mean nothing.
ENTRY static inline UNIFORM float4 middle_of_light(UNIFORM __global const Light* light) {
#define MIDDLE(constant, name, placed, aimed, extent) \
  if (light->kind == LIGHT_##constant) return middle_##name(light);
  AREA_LIGHTS(MIDDLE)
  MESH_LIGHTS(MIDDLE)
  return (float4)(light->position.xyz, 0.0f);
}

// A photon of a light other than the environment, by two numbers in [0, 1).
ENTRY static inline Emission emit_light(UNIFORM __global const Light* light, float c, float e) {
#define EMIT(constant, name, placed, aimed, extent) \
  if (light->kind == LIGHT_##constant) return emit_##name(light, c, e);
  DELTA_LIGHTS(EMIT)
  if (HAS_AREA_LIGHTS) {
    AREA_LIGHTS(EMIT)
    MESH_LIGHTS(EMIT)
    SKY_LIGHTS(EMIT)
  }
  return emit_along((float3)(0.0f), (float3)(0.0f));
}
