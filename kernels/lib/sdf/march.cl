// Sphere tracing (Hart 1996) of LANES rays at once, in field space. Over-relaxed steps are reverted if the
// two empty spheres do not touch (Keinert et al. 2014), so a step never exceeds what the field's bound proves
// empty.
#pragma once
// First, because fields in doubles rename what the files below define.
#include "lib/sdf/near.cl"

#include "lib/sdf/cut.cl"

// Rays may step across a surface, and then bisect to it.
#define SDF_CROSSES (SDF_TWO_SIDED || SDF_HAS_NEAR)

// t is in units of the direction's length, which need not be 1. The pixel's footprint at t is footprint + t *
// spread, in the same unit. Photons land on the surface that camera rays see, so theirs is that of a camera
// ray to the same place: spread times the distance, whose square is away2 + t (2 slope + t).
typedef struct MarchRays {
#if HAS_LANDINGS
  REAL away2, slope;
#endif
  REAL3 origin, direction;
  REAL t_min, t_max;
  REAL footprint, spread;
  u32 step_limit;
  MASK active;
  MASK inside;   // the ray travels inside the solid and looks for the exit
  MASK leaving;  // it starts on the surface: a hit counts only after it has moved clear
} MarchRays;

typedef struct MarchHits {
  REAL t;
  MASK hit;
  MASK cut;      // on the interval's boundary, which cuts the solid
  MASK limited;  // the step limit ended the march: treated as a hit, because the ray was close to the surface
  MASK steps;    // estimates used per lane
  MASK taken_back;  // relaxed steps that were reverted
  REAL threshold;   // at the hit, in field space
  REAL nearest;     // minimum estimate on the way, in field space; only with HAS_GLOW
} MarchHits;

// The distance at which a ray at t, of this speed in field space, has arrived.
static inline REAL march_threshold(__global const SdfField* restrict field, const MarchRays* rays, REAL t,
                                   REAL speed) {
#if HAS_LANDINGS
  const REAL away = real_sqrt(real_max(fma(t, fma(2.0f, rays->slope, t), rays->away2), (REAL)(0.0f)));
  const REAL footprint = rays->spread * speed * field->detail * away;
#else
  const REAL footprint =
      fma(t, rays->spread * speed * field->detail, rays->footprint * speed * field->detail);
#endif
  return real_clamp(footprint, (REAL)(field->lower.w), (REAL)(field->upper.w));
}

// Distance to the surface on each lane's side; negative on the wrong side.
static inline REAL march_estimate(u32 field, REAL3 p, MASK active, MASK inside,
                                  __global const float* restrict q) {
  if (SDF_TWO_SIDED && any_lane(inside & active)) {
    const REAL d = sdf_signed(field, p, active, q);
    return select(d, -d, inside);
  }
  return sdf_distance(field, p, active, q);
}

// march_estimate() as a call, for a few estimates per ray: compiles faster.
__attribute__((noinline)) static REAL called_estimate(u32 field, REAL3 p, MASK active, MASK inside,
                                                      __global const float* restrict q) {
  return march_estimate(field, p, active, inside, q);
}

// called_estimate(), but with the distance itself if the estimate is a small fraction of it. To first order:
// use near the surface only.
__attribute__((noinline)) static REAL called_near(u32 field, REAL3 p, MASK active, MASK inside,
                                                  __global const float* restrict q) {
  const REAL d = sdf_near(field, p, active, q);
  return select(d, -d, inside);
}
static inline REAL surface_distance(const Scene* scene, u32 field, REAL3 p, MASK active, MASK inside) {
  if (sdf_uneven(field, scene->sdf_parameters))
    return called_near(field, p, active, inside, scene->sdf_parameters);
  return called_estimate(field, p, active, inside, scene->sdf_parameters);
}

// Refines a hit within the threshold of a closed form to its surface: Newton's method along the ray, with the
// slope of the last two points, at most a few thresholds from the hit. A ray that only grazes the surface
// stops where it is nearest.
static inline REAL refine_hit(const Scene* scene, u32 field, const MarchRays* rays, REAL t,
                              REAL inverse_speed, REAL threshold, MASK hit) {
  const REAL reach = 64.0f * threshold * inverse_speed, low = t - reach, high = t + reach;
  REAL before = t,
       f_before = surface_distance(scene, field, along3(rays->origin, t, rays->direction), hit, rays->inside);
  REAL best = t, f_best = f_before;
  t = fma(f_before, inverse_speed, t);
  for (int i = 0; i < 5; ++i) {
    const REAL f =
        surface_distance(scene, field, along3(rays->origin, t, rays->direction), hit, rays->inside);
    const MASK nearer = MASK_OF(fabs(f) < fabs(f_best));
    best = select(best, t, nearer);
    f_best = select(f_best, f, nearer);
    const REAL slope = (f - f_before) / nonzero(t - before);
    const REAL next = fmin(fmax(t - f / nonzero(slope), low), high);
    const MASK falling = MASK_OF(slope < 0.0f);
    before = select(before, t, falling);
    f_before = select(f_before, f, falling);
    t = select(t, next, falling);
  }
  return select(rays->t_max, best, MASK_OF(best < rays->t_max));
}

// Bisects between `before` and t, on opposite sides, to find the surface.
static inline REAL bisect_crossing(const Scene* scene, u32 field, const MarchRays* rays, REAL before, REAL t,
                                   MASK lanes) {
  for (int i = 0; i < 12; ++i) {
    const REAL middle = 0.5f * (before + t);
    const REAL f = called_estimate(field, along3(rays->origin, middle, rays->direction), lanes, rays->inside,
                                   scene->sdf_parameters);
    const MASK out = MASK_OF(f < 0.0f);
    t = select(t, middle, out);
    before = select(middle, before, out);
  }
  return t;
}

// Moves a ray that has left an estimated surface on until the surface is about a threshold away, as far as
// rays arrive from outside, so that the next ray on either side starts clear of it and the normal is taken
// where all estimates are from outside.
static inline REAL clear_exit(const Scene* scene, u32 field, const MarchRays* rays, REAL t, REAL last,
                              REAL inverse_speed, REAL threshold, MASK lanes) {
  REAL clear = t;
  for (int i = 0; i < 8 && any_lane(lanes); ++i) {
    const REAL f =
        surface_distance(scene, field, along3(rays->origin, clear, rays->direction), lanes, NO_LANES);
    lanes &= MASK_OF(f < 0.75f * threshold);
    clear = select(clear, fma(real_max(f, 0.5f * threshold), inverse_speed, clear), lanes);
  }
  return select(t, clear, MASK_OF(clear < last));
}

// Moves hits on an estimated surface slightly behind another surface from which rays continue, because new
// rays must start on that surface's far side.
static inline REAL step_behind(const MarchRays* rays, const MarchHits* hits, REAL first, REAL inverse_speed) {
  const REAL clear = fma(0.25f * hits->threshold, inverse_speed, rays->t_min);
  const MASK close = MASK_OF(rays->t_min > 0.0f) & MASK_OF(first == rays->t_min) & MASK_OF(hits->t < clear);
  return select(hits->t, clear, close);
}

static inline MarchHits march_rays(const Scene* scene, u32 index, const MarchRays* rays) {
  __global const SdfField* restrict field = scene->sdf_fields + index;
  const REAL speed = length3(rays->direction), inverse_speed = 1.0f / speed;
  REAL first = (REAL)(-INFINITY), last = (REAL)(INFINITY);
  clip_to_interval(field, rays->origin, rays->direction, &first, &last);
  const MASK from_cut = MASK_OF(first > rays->t_min), to_cut = MASK_OF(last < rays->t_max);
  first = fmax(first, rays->t_min);
  last = fmin(last, rays->t_max);

  MarchHits hits = {first, NO_LANES, NO_LANES, NO_LANES, NO_LANES, NO_LANES, (REAL)(0.0f), (REAL)(INFINITY)};
  MASK active = rays->active & MASK_OF(first < last), leaving = rays->leaving, relaxed = NO_LANES;
  REAL t = first;
  REAL previous = (REAL)(0.0f), step = (REAL)(0.0f), slope = (REAL)(-1.0f);
  // The distance on the wrong side, in thresholds, at which a leaving ray has hit the surface again: it
  // starts on a refined surface, but before an estimated one (below).
  const bool smooth = field->flags & SDF_FLAGS & SDF_SMOOTH;
  const REAL wrong = select((REAL)(smooth ? -1.0f : 0.25f), (REAL)(-2.0f), rays->inside);
  const REAL pull = select(smooth ? (REAL)(0.0f) : -inverse_speed, (REAL)(0.0f), rays->inside);
  // A ray inside an estimated surface continues until it exits: depths are too rough to stop before that.
  const MASK to_crossing = smooth ? NO_LANES : rays->inside;
  MASK overshot = NO_LANES;
  REAL clear_at = first;  // the last point on the ray's side
  const bool uneven = sdf_uneven(index, scene->sdf_parameters);
  for (u32 i = 0; i < rays->step_limit && any_lane(active); ++i) {
    const REAL3 p = along3(rays->origin, t, rays->direction);
    const REAL f = march_estimate(index, p, active, rays->inside, scene->sdf_parameters) * field->safety;
    const REAL threshold = march_threshold(field, rays, t, speed);
    hits.steps -= active;
    REAL d = f;  // to the surface
    const MASK close = uneven ? active & MASK_OF(f < threshold) : NO_LANES;
    if (uneven && (HAS_GLOW || any_lane(close)))
      d = called_near(index, p, active, rays->inside, scene->sdf_parameters);
    if (HAS_GLOW)
      hits.nearest = select(hits.nearest, real_min(real_max(d, (REAL)(0.0f)), hits.nearest), active);
    if (uneven) d = select(f, d, close);

    // The spheres around the last point and this one must touch; otherwise revert to the end of the last one.
    const MASK gap = active & relaxed & MASK_OF(f + previous < step);
    hits.taken_back -= gap;
    const MASK forward = active & ~gap;

    const REAL near = select(threshold, (REAL)(0.0f), to_crossing);
    const MASK arrived = forward & select(MASK_OF(d < near), MASK_OF(d < wrong * threshold), leaving);
    if (SDF_CROSSES) {
      overshot |= arrived & MASK_OF(d < 0.0f) & (uneven && smooth ? rays->inside | ~leaving : rays->inside);
      clear_at = select(clear_at, t, forward & ~arrived);
    }
    leaving &= ~(forward & MASK_OF(d >= threshold));
    hits.hit |= arrived;
    // Move back until the surface is a threshold away, so that new rays start clear of it.
    const REAL back = real_clamp(threshold - d, (REAL)(0.0f), step);
    hits.t = select(hits.t, fma(back, pull, t), arrived);
    hits.threshold = select(hits.threshold, threshold, active);
    if (i == 0) hits.cut = arrived & from_cut & ~rays->inside & MASK_OF(f <= 0.0f);

    // Along a plane the estimate is linear: the longest step whose spheres still touch solves f + (f + slope
    // s) = s. The slope is smoothed, so that one odd sample does not spoil the next steps.
    const REAL measured = real_clamp((f - previous) * rough_inverse(real_max(step, (REAL)(1e-30f))),
                                     (REAL)(-1.0f), (REAL)(0.5f));
    slope = select(slope, 0.5f * (slope + measured), forward & MASK_OF(step > 0.0f));
    slope = select(slope, (REAL)(-1.0f), gap);
    REAL proven = real_max(f, 0.5f * threshold);
    if (uneven)  // a change of sign reveals a step across the surface, to be bisected
      proven = select(proven, real_max(proven, real_min(0.5f * d, 4.0f * threshold)), close);
    const REAL longer = 2.0f * f * rough_inverse(1.0f - slope);
    const REAL remaining = (last - t) * speed;
    const MASK through = forward & ~arrived & MASK_OF(proven >= remaining);
    hits.cut |= through & to_cut & rays->inside;
    active &= ~(arrived | through);

    const REAL stride = real_min(select(proven, real_max(longer, proven), ~leaving), remaining);
    relaxed = MASK_OF(stride > proven) & forward;
    // Reverted: from the previous point by exactly its proven distance.
    t = select(select(t, fma(stride, inverse_speed, t), active), fma(previous - step, inverse_speed, t), gap);
    step = select(stride, previous, gap);
    previous = select(f, previous, gap);
  }
  hits.limited = active;
  hits.t = select(select(hits.t, t, active), last, hits.cut & ~hits.hit);
  hits.hit |= active | hits.cut;
  // Depths are not a proven bound for every fractal (definition.h).
  if (SDF_CROSSES && any_lane(overshot))
    hits.t = select(hits.t, bisect_crossing(scene, index, rays, clear_at, hits.t, overshot), overshot);
  const MASK out = to_crossing & overshot;
  if (SDF_CROSSES && any_lane(out))
    hits.t =
        select(hits.t, clear_exit(scene, index, rays, hits.t, last, inverse_speed, hits.threshold, out), out);
  if (!smooth) hits.t = select(hits.t, step_behind(rays, &hits, first, inverse_speed), hits.hit & ~hits.cut);
  if (smooth) {
    const MASK on_surface = hits.hit & ~hits.cut;
    const REAL refined = refine_hit(scene, index, rays, hits.t, inverse_speed, hits.threshold, on_surface);
    hits.t = select(hits.t, refined, on_surface);
  }
  return hits;
}
