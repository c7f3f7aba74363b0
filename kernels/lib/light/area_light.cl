// Where lights are, and places on those with an extent.
#pragma once
#include "lib/core/tables.h"

// The part of the way to a light that shadow rays go, since the light's own surface lies at its end.
#define SHORT_OF_LIGHT 0x1.ffep-1f

// Whether a light has a position: it is neither parallel nor an environment.
static inline bool has_place(__global const Light* light) {
  return light->kind != LIGHT_DIRECTIONAL && light->kind != LIGHT_SUN && light->kind != LIGHT_ENVIRONMENT;
}

// The middle of a light; w: the square of its size. Shorter distances to the middle mean nothing.
static inline float4 middle_of_light(__global const Light* light) {
  const float3 corner = light->position.xyz, edges = light->edge_u.xyz + light->edge_v.xyz;
  if (light->kind == LIGHT_RECTANGLE) return (float4)(corner + 0.5f * edges, 0.1f * light->direction.w);
  if (light->kind == LIGHT_TRIANGLE)
    return (float4)(corner + edges * (1.0f / 3.0f), 0.1f * light->direction.w);
  if (light->kind == LIGHT_DISK) return (float4)(corner, 0.1f * light->direction.w);
  return (float4)(corner, light->kind == LIGHT_SPHERE ? light->edge_u.w * light->edge_u.w : 0.0f);
}

// A place on a light with an extent, the normal there, and the light's area.
static inline float3 place_on_light(__global const Light* light, float c, float e, float3* n, float* area) {
  *n = light->direction.xyz;
  *area = light->direction.w;
  const float3 corner = light->position.xyz, x = light->edge_u.xyz, y = light->edge_v.xyz;
  if (light->kind == LIGHT_RECTANGLE) return corner + c * x + e * y;
  if (light->kind == LIGHT_DISK) return corner + sqrt(c) * (cospi(2.0f * e) * x + sinpi(2.0f * e) * y);
  if (light->kind == LIGHT_TRIANGLE) return corner + (1.0f - sqrt(c)) * x + e * sqrt(c) * y;
  const float up = 1.0f - 2.0f * c, side = sqrt(fmax(1.0f - up * up, 0.0f));
  *n = (float3)(side * cospi(2.0f * e), side * sinpi(2.0f * e), up);
  *area = 4.0f * M_PI_F * light->edge_u.w * light->edge_u.w;
  return corner + light->edge_u.w * *n;
}
