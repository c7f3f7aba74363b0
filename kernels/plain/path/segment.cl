// Moves rays from their starts to the next visible surfaces: crosses interfaces overruled by priority,
// maintains the media stack and accumulates absorption.
#include "plain/path/face.cl"
#include "plain/path/media.cl"

#define INTERFACE (MATERIAL_TRANSMITS | MATERIAL_THIN)  // flags that tell whether a face only transmits

// A ray's next surface. `before` and `after` are the media on its two sides; equal if nothing is crossed.
typedef struct Encounter {
  SurfaceHit hit;
  Face face;
  int before, after;
  float3 absorbed;  // factor on the ray's light from its start to the hit
  HAVING(HAS_TOUCHING) MediaStack behind;
  HAVING(HAS_TOUCHING) float apart;  // how far apart the touching faces may be
  HAVING(HAS_SIDES) int crossed;     // bits of other fields that touch the one that is hit
  HAVING(HAS_PARALLAX) float below;  // depth of the hit below a surface in whose relief it lies, or 0
  HAVING(HAS_PARALLAX) float3 top;   // that surface's normal
} Encounter;

typedef struct LANES(Passages) {
  MediaStack behind;
  float end, apart;
  int overflows, strays, crossed;
} Passage;
void note_lost_media(int overflows, int strays, HERE, UNIFORM u32* counts);

// Hit and face become those of the face that is seen, but for the distance. `mask`: see join_faces().
HAVING(HAS_TOUCHING)
Passage meet_touching(UNIFORM const Scene* scene, const SceneRay* ray, UNIFORM u32 mask, SurfaceHit* hit,
                      Face* face, HERE, UNIFORM u32* counts);

// Whether the hit is on an instance that may touch others.
ENTRY static inline bool may_touch_others(UNIFORM __global const Instance* instances, const SurfaceHit* hit) {
  bool touches = false;
  EACH_ALIKE(u32, index, hit->instance) touches = instances[index].touch > 0.0f;
  return touches;
}

// The fraction of light from the ray's end that the world's fog transmits, outside all solids.
static inline float clear_of_fog(UNIFORM const Scene* scene, const Encounter* met) {
  if (met->before != 0) return 1.0f;
  return real_exp(-scene->info->fog.w * met->hit.t);
}

// An interface is unseen if both sides are the same medium, or a clear material separates media of equal
// index.
static inline bool is_unseen(UNIFORM __global const Medium* media, int flags, int before, int after) {
  return before == after || ((flags & (int)MATERIAL_CLEAR) != 0 && same_index(media, after, before));
}

// The hit on a face that transmits light. Returns whether it is unseen; then the ray's media become those
// behind.
HAVING(HAS_MEDIA)
static inline bool cross_interface(UNIFORM const Scene* scene, SceneRay* ray, Encounter* met,
                                   UNIFORM u32* counts) {
  MediaStack behind = ray->media;
  float end = met->hit.t;
  bool touching = false;
  if (HAS_TOUCHING) {
    touching = may_touch_others(scene->instances, &met->hit);
    if (touching) {
      const Passage passage = meet_touching(scene, ray, MATERIAL_TRANSMITS, &met->hit, &met->face, counts);
      behind = passage.behind;
      end = passage.end;
      met->behind = behind;
      met->apart = passage.apart;
      if (HAS_SIDES) met->crossed = passage.crossed;
      note_lost_media(passage.overflows, passage.strays, counts);
    }
  }
  bool unseen = false;
  if ((met->face.flags & (int)INTERFACE) == (int)MATERIAL_TRANSMITS) {
    if (!touching && !cross_boundary(&behind, met->face.medium, met->face.entering))
      note_lost_media((int)met->face.entering, 1 - (int)met->face.entering, counts);
    met->after = current_medium(scene->media, &behind);
    if (HAS_TOUCHING) met->behind = behind;
    unseen =
        ray->crossings < MAX_CROSSINGS && is_unseen(scene->media, met->face.flags, met->before, met->after);
    if (unseen) {
      ray->media = behind;
      if (HAS_SIDES) ray->sides ^= met->crossed;
      met->hit.t = end;
    }
  }
  return unseen;
}

// Leaves the medium before any hit.
HAVING(HAS_MEDIA)
static inline bool leave_medium_before(UNIFORM const Scene* scene, SceneRay* ray, Encounter* met,
                                       UNIFORM u32* counts) {
  const int here = current_media(scene->media, ray);
  bool unseen = false;
  met->before = here;
  met->after = here;
  if (HAS_TOUCHING) {
    met->behind = ray->media;
    met->apart = 0.0f;
  }
  if (HAS_SIDES) met->crossed = 0;
  if ((met->face.flags & (int)MATERIAL_TRANSMITS) != 0) unseen = cross_interface(scene, ray, met, counts);
  if (!unseen || met->after != here) met->absorbed *= absorb(scene->media, here, met->hit.t - ray->since);
  if (unseen) {
    if (met->after != here) ray->since = met->hit.t;
    continue_behind(scene->info, ray, &met->hit, met->face.entering);
  }
  return unseen;
}

// Crosses the interface that the ray has hit, if it cannot be seen. Returns whether it does; the ray then has
// the state behind.
ENTRY static inline bool cross_unseen(UNIFORM const Scene* scene, SceneRay* ray, Encounter* met,
                                      UNIFORM u32* counts) {
  bool unseen = false;
  met->face = hit_faces(scene, ray->d, &met->hit);
  if (HAS_MEDIA) unseen = leave_medium_before(scene, ray, met, counts);
  return unseen;
}

ENTRY static inline void start_encounters(Encounter* met) {
  met->before = 0;
  met->after = 0;
  met->absorbed = (float3)(1.0f);
}

// Processes the interface met->hit. Returns whether the ray does not see it; it then has the state behind.
// The media of others are those just before the surface. Crossed interfaces do not move the origin, so hits
// behind a vanished interface keep their bits.
ENTRY static inline bool reach_interfaces(UNIFORM const Scene* scene, SceneRay* ray, Encounter* met,
                                          UNIFORM u32* counts) {
  start_encounters(met);
  return cross_unseen(scene, ray, met, counts);
}

// A camera ray continues behind a lamp hidden from it. Returns whether it does.
ENTRY static inline bool pass_hidden(UNIFORM const Scene* scene, SceneRay* ray, const Encounter* met) {
  if (!HAS_EMISSION || (met->face.flags & (int)MATERIAL_OFF_CAMERA) == 0) return false;
  if (HAS_MEDIA) ray->since = met->hit.t;
  continue_behind(scene->info, ray, &met->hit, met->face.entering);
  return true;
}

// The priority of the medium around the ray.
ENTRY static inline int priority_around(UNIFORM const Scene* scene, const SceneRay* ray) {
  int priority = (int)0x80000000u;
  const int here = current_media(scene->media, ray);
  if (here != 0) EACH_ALIKE(int, index, here) priority = scene->media[index].priority;
  return priority;
}

// The offset of secondary rays, considering the gap between touching faces.
static inline float offset_beyond(const Encounter* met, float offset) {
  float beyond = offset;
  if (HAS_TOUCHING && met->apart > 0.0f) beyond = met->apart;
  return beyond;
}

// A child, a copy of `ray`, enters the media behind the hit; thin surfaces change none.
static inline void enter_behind(const Encounter* met, SceneRay* child) {
  if (HAS_MEDIA && HAS_SIDES) child->sides ^= met->crossed;
  if (HAS_TOUCHING)
    child->media = met->behind;
  else if (HAS_MEDIA && (met->face.flags & (int)MATERIAL_THIN) == 0)
    cross_boundary(&child->media, met->face.medium, met->face.entering);
}

// A shadow ray goes behind an interface that lets light pass, into its media. Of touching ones, hit and face
// become those that are seen.
static inline void pass_interface(UNIFORM const Scene* scene, SceneRay* ray, SurfaceHit* hit, Face* face,
                                  UNIFORM u32* counts) {
  const u32 opaque = MATERIAL_TRANSMITS | MATERIAL_SHADOW_OPAQUE;
  if ((face->flags & (int)opaque) != (int)MATERIAL_TRANSMITS) return;
  bool touching = false;
  if (HAS_TOUCHING) {
    touching = may_touch_others(scene->instances, hit);
    if (touching) {
      const Passage passage = meet_touching(scene, ray, opaque, hit, face, counts);
      ray->media = passage.behind;
      if (HAS_SIDES) ray->sides ^= passage.crossed;
      hit->t = passage.end;
    }
  }
  if (!touching && (face->flags & (int)MATERIAL_THIN) == 0)
    cross_boundary(&ray->media, face->medium, face->entering);
}

// Whether the ray would see a surface that it enters. Parts of an interface between touching solids count as
// unseen: what is there belongs to neither.
static inline bool sees_interface(UNIFORM const Scene* scene, const SceneRay* ray, const SurfaceHit* hit,
                                  const Face* face) {
  if (!HAS_MEDIA || (face->flags & (int)INTERFACE) != (int)MATERIAL_TRANSMITS) return true;
  if (HAS_TOUCHING && may_touch_others(scene->instances, hit)) return false;
  MediaStack behind = ray->media;
  cross_boundary(&behind, face->medium, true);
  return !is_unseen(scene->media, face->flags, current_media(scene->media, ray),
                    current_medium(scene->media, &behind));
}
