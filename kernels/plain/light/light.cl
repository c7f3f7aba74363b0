// Ways to lights of every kind.
#include "plain/light/area_light.cl"

UNIFORM float sun_pdf(UNIFORM __global const Light* sun, UNIFORM float chance);
LightSample sample_environment(UNIFORM const Scene* scene, float u_x, float u_y, HERE);

// The way from the point p to a light without extent.
ENTRY static inline LightSample way_to_lamp(UNIFORM __global const Light* light, float3 p) {
  LightSample sample;
  sample.pdf = 1.0f;
  sample.delta = true;
  sample.radiance = light->color.xyz;
  if (light->kind == LIGHT_DIRECTIONAL) {
    sample.wi = -light->direction.xyz;
    sample.distance = INFINITY;
    return sample;
  }
  const float3 to = light->position.xyz - p;
  sample.wi = safe_unit3(to);
  const float d = dot(to, sample.wi);
  sample.distance = d;
  if (light->falloff_linear != 0.0f || light->falloff_quadratic != 0.0f || light->falloff_constant != 1.0f)
    sample.radiance = sample.radiance / (float3)(fma(light->falloff_quadratic * d, d,
                                                     fma(light->falloff_linear, d, light->falloff_constant)));
  if (light->edge_v.x > 0.0f) {  // as KHR_lights_punctual suggests
    const float part = d * light->edge_v.x, square = part * part;
    sample.radiance *= real_max(1.0f - square * square, 0.0f);
  }
  if (light->kind == LIGHT_SPOT) {
    const float cosine = -dot(sample.wi, light->direction.xyz);
    const float outer = light->direction.w, inner = light->color.w;
    float s = cosine >= outer ? 1.0f : 0.0f;
    if (inner > outer) s = real_clamp((cosine - outer) / (inner - outer), 0.0f, 1.0f);
    sample.radiance *= s * s * (light->edge_u.x - light->edge_u.y * s);
  }
  return sample;
}

// A direction to a sun, uniform in its disk in the sky.
HAVING(HAS_AREA_LIGHTS)
static inline LightSample sample_sun(UNIFORM __global const Light* light, float u_x, float u_y) {
  const float cap = fabs(light->direction.w);
  const float drop = u_x * cap, sine2 = drop * (2.0f - drop);
  const LightSample sample = {direction_at(-light->direction.xyz, 1.0f - drop, real_sqrt(sine2), u_y),
                              light->color.xyz, INFINITY, sun_pdf(light, 1.0f), false};
  return sample;
}

// A way from the point p to the light `index`, chosen by the two numbers u in [0, 1)^2, which lights without
// extent leave alone.
ENTRY static inline LightSample sample_light(UNIFORM const Scene* scene, UNIFORM u32 index, float3 p,
                                             float u_x, float u_y) {
  __global const Light* light = scene->lights + index;
  if (HAS_AREA_LIGHTS && light->kind == LIGHT_SUN) return sample_sun(light, u_x, u_y);
  if (HAS_ENVIRONMENT && light->kind == LIGHT_ENVIRONMENT) return sample_environment(scene, u_x, u_y);
  if (HAS_AREA_LIGHTS && light->kind >= LIGHT_RECTANGLE) return sample_area_light(light, p, u_x, u_y);
  return way_to_lamp(light, p);
}
