// Ways to lights of every kind, and what is seen of them.
#include "plain/light/emission.cl"
#include "plain/light/environment.cl"

static inline bool is_in_sky(UNIFORM __global const Light* light) {
  return (LIGHTS_OF_SKY >> light->kind & 1u) != 0u;
}

// Whether rays may meet the light `index`: it is visible and not a delta light.
static inline UNIFORM bool rays_meet(UNIFORM const Scene* scene, UNIFORM u32 index) {
  __global const Light* light = scene->lights + index;
  if (light->kind == LIGHT_ENVIRONMENT) return scene->info->sees_environment != 0u;
  if (is_in_sky(light)) return light->direction.w > 0.0f;
  return has_extent(light) && light->position.w == 0.0f;
}

// The way from the point p to a delta light.
static inline LightSample way_to_lamp(UNIFORM __global const Light* light, float3 p) {
#define GO_TO(constant, name, placed, aimed, extent) \
  if (light->kind == LIGHT_##constant) return sample_##name(light, p);
  DELTA_LIGHTS(GO_TO)
  return sample_directional(light, p);
}

// A way from the point p to an area light, chosen by the two numbers u in [0, 1)^2.
static inline LightSample sample_area_light(UNIFORM __global const Light* light, float3 p, float u_x,
                                            float u_y) {
#define SAMPLE_AREA(constant, name, placed, aimed, extent) \
  if (light->kind == LIGHT_##constant) return sample_##name(light, p, u_x, u_y);
  AREA_LIGHTS(SAMPLE_AREA)
  return sample_triangle(light, p, u_x, u_y);
}

// The density, per steradian, with which sample_area_light() chooses the direction wi from p, which meets the
// light at the distance d.
ENTRY static inline float area_light_pdf(UNIFORM __global const Light* light, float3 p, float3 wi, float d) {
#define PDF_OF_AREA(constant, name, placed, aimed, extent) \
  if (light->kind == LIGHT_##constant) return pdf_##name(light, p, wi, d);
  AREA_LIGHTS(PDF_OF_AREA)
  return pdf_triangle(light, p, wi, d);
}

static inline UNIFORM bool has_corners(UNIFORM __global const Light* light) {
  return (LIGHTS_WITH_CORNERS >> light->kind & 1u) != 0u;
}
static inline SeenLight see_light(UNIFORM __global const Light* light, float3 p) {
#define SEE(constant, name, placed, aimed, extent) \
  if (light->kind == LIGHT_##constant) return corners_##name(light, p);
  AREA_LIGHTS(SEE)
  const float3 none = (float3)(0.0f);
  return seen_square(none, none, none, false, true);
}

// A way from the point p to the light `index`. Delta lights ignore the numbers.
ENTRY static inline LightSample sample_light(UNIFORM const Scene* scene, UNIFORM u32 index, float3 p,
                                             float u_x, float u_y) {
  __global const Light* light = scene->lights + index;
  if (HAS_ENVIRONMENT && light->kind == LIGHT_ENVIRONMENT) return sample_environment(scene, u_x, u_y);
#define SAMPLE_SKY(constant, name, placed, aimed, extent) \
  if (HAS_AREA_LIGHTS && light->kind == LIGHT_##constant) return sample_##name(light, u_x, u_y);
  SKY_LIGHTS(SAMPLE_SKY)
  if (HAS_AREA_LIGHTS && has_extent(light)) return sample_area_light(light, p, u_x, u_y);
  return way_to_lamp(light, p);
}

// A way from the point p to its light `chosen`; `seen`: rays may meet it.
static inline LightSample sample_chosen(UNIFORM const Scene* scene, float3 p, float u_x, float u_y,
                                        int chosen, bool* seen) {
  LightSample light;
  bool meets = false;
  EACH_ALIKE(u32, index, (u32)chosen) {
    light = sample_light(scene, index, p, u_x, u_y);
    if (rays_meet(scene, index)) meets = true;
  }
  *seen = meets;
  return light;
}

// The sky's lights: light from the direction d, and its density where the light is chosen with `chance`.
// `camera`: the ray comes from the camera.
HAVING(HAS_AREA_LIGHTS)
static inline float3 sky_light_radiance(UNIFORM __global const Light* light, float3 d, bool camera) {
#define RADIANCE(constant, name, placed, aimed, extent) \
  if (light->kind == LIGHT_##constant) return radiance_##name(light, d, camera);
  SKY_LIGHTS(RADIANCE)
  return (float3)(0.0f);
}
HAVING(HAS_AREA_LIGHTS)
static inline float sky_light_pdf(UNIFORM __global const Light* light, UNIFORM float chance) {
#define PDF_OF_SKY(constant, name, placed, aimed, extent) \
  if (light->kind == LIGHT_##constant) return pdf_##name(light, chance);
  SKY_LIGHTS(PDF_OF_SKY)
  return 0.0f;
}
