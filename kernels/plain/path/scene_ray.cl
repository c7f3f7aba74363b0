// Rays on their way through the scene, with what travels along, and how they start again from what they met.
#include "plain/path/camera.cl"

typedef struct LANES(Hits, join_hits) {
  float t, u, v;
  int instance, prim;
  float3 ng;
} SurfaceHit;

#define FROM_NOWHERE (-1)
#define UNKNOWN_SIDES (-1)
#define MOST_SIDES 31  // remembered

// Up to eight media in order of entry, the last in the lowest byte of `low`; a byte holds the medium's index
// plus one, 0 is empty: small, as waiting rays keep it. The host rejects scenes with more than MAX_MEDIA
// media.
typedef struct MediaStack {
  int low, high;
} MediaStack;

// A ray in world space with what travels along.
typedef struct SceneRay {
  float3 o, d;  // d unit
  float t_min, t_max;
  MediaStack media;                      // at t_min
  HAVING(HAS_MEDIA) float since;         // distance from which on it is in its medium
  HAVING(HAS_CROSSINGS) int crossings;   // unseen interfaces or filters behind it
  HAVING(HAS_SDF) int from;              // the field that it starts on: instance * 2, plus 1 inside of it
  HAVING(HAS_SIDES) int sides;           // bit i: inside the field i of those that it remembers
  HAVING(HAS_SDF) float footprint;       // of the pixel at o, in world units
  HAVING(HAS_CONES) float cone_width;    // of the cone at o, in world units
  HAVING(HAS_CONES) float cone_spread;   // its growth on a unit of the way
  HAVING(HAS_GLOW) float3 glow;          // gathered from fields that it passed
  HAVING(HAS_OBJECT_MOTION) float time;  // one for a whole path
} SceneRay;

ENTRY static inline SceneRay begun_ray(const CameraRay* camera, UNIFORM const MediaStack* media) {
  SceneRay ray;
  ray.o = camera->o;
  ray.d = camera->d;
  ray.t_min = camera->t_min;
  ray.t_max = camera->t_max;
  ray.media = *media;
  if (HAS_MEDIA) ray.since = 0.0f;
  if (HAS_CROSSINGS) ray.crossings = 0;
  if (HAS_SDF) {
    ray.from = FROM_NOWHERE;
    ray.footprint = 0.0f;
  }
  if (HAS_SIDES) ray.sides = UNKNOWN_SIDES;
  if (HAS_CONES) {
    ray.cone_width = 0.0f;
    ray.cone_spread = camera->spread;
  }
  if (HAS_GLOW) ray.glow = (float3)(0.0f);
  if (HAS_OBJECT_MOTION) ray.time = camera->time;
  return ray;
}

// The light that it has gathered from fields that glow.
ENTRY static inline float3 emitted(const SceneRay* ray) {
  float3 light = (float3)(0.0f);
  if (HAS_GLOW) light = ray->glow;
  return light;
}
ENTRY static inline void forget_glow(SceneRay* ray) {
  if (HAS_GLOW) ray->glow = (float3)(0.0f);
}

ENTRY static inline bool may_cross(const SceneRay* ray) {
  if (HAS_CROSSINGS) return ray->crossings < MAX_CROSSINGS;
  return false;
}
// The ray continues `before`, which has crossed one interface more.
static inline void cross_further(const SceneRay* before, SceneRay* ray) {
  if (HAS_CROSSINGS) ray->crossings = before->crossings + 1;
}

// The bit of an instance in SceneRay.sides; 0 if it is no field, or one not remembered.
static inline int side_bit(UNIFORM __global const SceneInfo* info, int instance) {
  const int number = instance - (int)info->instance_count;
  return number >= 0 && number < MOST_SIDES ? 1 << (number & 31) : 0;
}

// side_bit() for hand-written code about one ray.
ENTRY static inline UNIFORM int side_of_one(UNIFORM __global const SceneInfo* info, UNIFORM int instance) {
  return side_bit(info, instance);
}

// The ray restarts from what it has hit: notes which field, and which side of it.
static inline void start_on_hits(UNIFORM __global const SceneInfo* info, SceneRay* ray, const SurfaceHit* hit,
                                 bool inside) {
  if (HAS_SDF) {
    const bool on_field = hit->instance >= (int)info->instance_count;
    ray->from = on_field ? hit->instance * 2 + (int)inside : FROM_NOWHERE;
    if (HAS_SIDES) {
      const int bit = side_bit(info, hit->instance);
      ray->sides = (ray->sides & ~bit) | (inside ? bit : 0);
    }
  }
}

// A new ray, whose origin is the hit of `ray`, restarts from the side `inside`; `ray` is still the one that
// hit.
static inline void start_on_surfaces(UNIFORM __global const SceneInfo* info, SceneRay* ray,
                                     const SurfaceHit* hit, bool inside) {
  if (HAS_SDF) ray->footprint = fma(hit->t, pixel_spread(info), ray->footprint);
  if (HAS_CONES) ray->cone_width = fma(hit->t, ray->cone_spread, ray->cone_width);
  if (HAS_MEDIA) ray->since = 0.0f;
  if (HAS_CROSSINGS) ray->crossings = 0;
  forget_glow(ray);
  start_on_hits(info, ray, hit, inside);
}

// The ray continues behind a surface that it does not see.
ENTRY static inline void continue_behind(UNIFORM __global const SceneInfo* info, SceneRay* ray,
                                         const SurfaceHit* hit, bool entering) {
  ray->t_min = hit->t;
  if (HAS_CROSSINGS) ++ray->crossings;
  start_on_hits(info, ray, hit, entering);
}
