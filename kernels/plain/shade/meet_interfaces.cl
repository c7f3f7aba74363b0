// Takes rays to their next interface, also to objects in the relief of another surface: rays that have hit a
// surface with heights below it continue to these heights, and hits on the way come first. Also how rays
// leave a relief.
#include "plain/path/segment.cl"
#include "plain/shade/parallax.cl"

#define RELIEF_FACES 4  // of the surface's own object that a ray passes below it

void nearest_hits(UNIFORM const Scene* scene, SceneRay* ray, HERE, UNIFORM bool coherent, SurfaceHit* hit,
                  UNIFORM u32* counts);

// The depth of a surface's relief, in the world; 0 without a relief.
HAVING(HAS_PARALLAX)
static inline float relief_depth(UNIFORM const Scene* scene, int material, int instance) {
  float depth = parallax_of(scene, material);
  EACH_ALIKE(u32, index, (u32)instance) depth = depth / scene->instances[index].pattern_scale.w;
  return depth;
}

// The length of a ray of the direction d through a relief of this depth below a surface with the normal n.
static inline float way_through(float3 n, float3 d, float depth) {
  return depth / real_max(fabs(dot(n, d)), PARALLAX_SLANT);
}

// The nearest hit between `hit`, on a surface with a relief, and the distance `end`, on another object.
// Returns whether there is one.
HAVING(HAS_PARALLAX)
static inline bool meet_in_relief(UNIFORM const Scene* scene, const SceneRay* ray, const SurfaceHit* hit,
                                  float end, SurfaceHit* other, UNIFORM u32* counts) {
  SceneRay below = *ray;
  continue_behind(scene->info, &below, hit, true);
  below.t_max = end;
  bool found = false;
  for (int k = 0; k < RELIEF_FACES; ++k) {
    SurfaceHit next;
    nearest_hits(scene, &below, false, &next, counts);
    if (!hit_anything(&next)) break;
    found = next.instance != hit->instance;
    if (found) {
      *other = next;
      break;
    }
    below.t_min = next.t;
  }
  return found;
}

// Moves a hit on a surface with a relief to a hit before its heights. `met` receives the depth below that
// surface. In the relief of a transparent surface only opaque hits count: a ray would not know that it is
// outside the surface's solid in the relief and inside behind it.
HAVING(HAS_PARALLAX)
ENTRY static void enter_relief(UNIFORM const Scene* scene, const SceneRay* ray, Encounter* met,
                               UNIFORM u32* counts) {
  met->below = 0.0f;
  met->top = (float3)(0.0f);
  if (!hit_anything(&met->hit)) return;
  const Face face = hit_faces(scene, ray->d, &met->hit);
  if (!face.entering || !has_parallax(scene, face.material)) return;
  if (!sees_interface(scene, ray, &met->hit, &face)) return;
  const float3 top = safe_unit3(face.outward);
  const float length = way_through(top, ray->d, relief_depth(scene, face.material, met->hit.instance));
  SurfaceHit other = met->hit;
  if (!meet_in_relief(scene, ray, &met->hit, met->hit.t + length, &other, counts)) return;
  const Face thing = hit_faces(scene, ray->d, &other);
  if ((face.flags & thing.flags & (int)MATERIAL_TRANSMITS) != 0) return;
  SurfaceInteraction s;
  interact(scene, ray->o, ray->d, &met->hit, &face, &s);
  set_footprints(scene, ray, met->hit.t, &s);
  add_parallax(scene, ray->d, &s);
  const float passed = other.t - met->hit.t;
  if (!(passed < s.sunk * length)) return;
  met->below = passed * fabs(dot(top, ray->d));
  met->top = s.ng;
  met->hit = other;
}

ENTRY static inline void note_depth(const Encounter* met, SurfaceInteraction* s) {
  if (HAS_PARALLAX) {
    s->below = met->below;
    s->top = met->top;
  }
}

// Where a ray in direction wi leaves the relief that contains the surface, which has none: `way` receives the
// distance.
static inline float3 leave_relief(const SurfaceInteraction* s, float3 wi, OUT float* way) {
  *way = 0.0f;
  float3 p = s->p;
  if (HAS_PARALLAX) {
    const float rise = real_max(dot(s->top, wi), 0.0f);
    if (rise > 0.0f) *way = s->below / real_max(rise, PARALLAX_SLANT);
    p = along(along(p, *way, wi), real_max(s->below - *way * rise, 0.0f), s->top);
  }
  return p;
}
// The normal of the surface through which it leaves.
static inline float3 leaving_normal(const SurfaceInteraction* s) {
  if (HAS_PARALLAX) return s->below > 0.0f ? s->top : s->ng;
  return s->ng;
}

// How far behind the surface a ray of the direction d has hit its heights.
ENTRY static inline float way_to_heights(UNIFORM const Scene* scene, const SurfaceInteraction* s, float3 d) {
  float way = 0.0f;
  if (HAS_PARALLAX && s->sunk > 0.0f)
    way = s->sunk * way_through(s->ng, d, relief_depth(scene, s->material, s->instance));
  return way;
}

// Where a ray of the direction d continues behind the surface.
static inline float3 point_behind(UNIFORM const Scene* scene, const SurfaceInteraction* s, float3 d) {
  const float3 behind = along(s->p, -s->offset, s->ng);
  if (HAS_PARALLAX) return along(behind, way_to_heights(scene, s, d), d);
  return behind;
}

// Moves the ray to what it hits next in (t_min, t_max]. Returns whether it does not see it. `coherent`: so
// are the rays.
ENTRY static inline bool meet_interfaces(UNIFORM const Scene* scene, SceneRay* ray, UNIFORM bool coherent,
                                         Encounter* met, UNIFORM u32* counts) {
  nearest_hits(scene, ray, coherent, &met->hit, counts);
  if (HAS_PARALLAX) enter_relief(scene, ray, met, counts);
  return reach_interfaces(scene, ray, met, counts);
}

// Moves a ray that waits behind a surface which it does not see to the next visible one. Those of the camera
// pass objects that are hidden from them.
ENTRY static inline void see_behind(UNIFORM const Scene* scene, SceneRay* ray, bool camera, Encounter* met,
                                    UNIFORM u32* counts) {
  for (;;) {
    SurfaceHit next;
    nearest_hits(scene, ray, false, &next, counts);
    met->hit = next;
    if (HAS_PARALLAX) enter_relief(scene, ray, met, counts);
    if (cross_unseen(scene, ray, met, counts)) continue;
    if (!camera || !pass_hidden(scene, ray, met)) break;
  }
}

// Moves the ray to its next visible surface.
ENTRY static inline void see_surfaces(UNIFORM const Scene* scene, SceneRay* ray, bool camera,
                                      UNIFORM bool coherent, Encounter* met, UNIFORM u32* counts) {
  bool waits = meet_interfaces(scene, ray, coherent, met, counts);
  if (!waits && camera) waits = pass_hidden(scene, ray, met);
  if ((HAS_MEDIA || HAS_EMISSION) && waits) see_behind(scene, ray, camera, met, counts);
}
