// Light from a disk in the sky, uniform in solid angle. The disk's size is 1 minus the cosine of its radius.
#include "plain/light/light_sample.cl"

HAVING(HAS_AREA_LIGHTS);

static inline float pdf_sun(UNIFORM __global const Light* light, UNIFORM float chance) {
  return chance / (2.0f * M_PI_F * fabs(light->direction.w));
}

static inline LightSample sample_sun(UNIFORM __global const Light* light, float u_x, float u_y) {
  const float cap = fabs(light->direction.w);
  const float drop = u_x * cap, sine2 = drop * (2.0f - drop);
  const LightSample sample = {direction_at(-light->direction.xyz, 1.0f - drop, real_sqrt(sine2), u_y),
                              light->color.xyz, INFINITY, pdf_sun(light, 1.0f), false};
  return sample;
}

// The square of the chord from the sun's middle is twice 1 minus the cosine, with more digits. `camera`: the
// ray comes from the camera, which some suns are hidden from.
static inline float3 radiance_sun(UNIFORM __global const Light* light, float3 d, bool camera) {
  const float3 chord = d + light->direction.xyz;
  bool seen = dot(chord, chord) <= 2.0f * light->direction.w;
  if (light->position.w != 0.0f) seen = seen && !camera;
  return seen ? light->color.xyz : (float3)(0.0f);
}

static inline Emission emit_sun(UNIFORM __global const Light* light, float c, float e) {
  const float drop = c * fabs(light->direction.w), side = sqrt(drop * (2.0f - drop));
  return emit_along(direction_beside(light->direction.xyz, drop, side, e),
                    light->color.xyz / pdf_sun(light, 1.0f));
}
