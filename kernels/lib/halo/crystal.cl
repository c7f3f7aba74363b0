// Hexagonal ice prisms in sunlight: their orientation, and where a ray enters. One crystal per lane.
#pragma once
#include "lib/halo/numbers.cl"

// Light in a crystal. `at`, `d` (unit) and `sunlight` are in the crystal's coordinates: z is its axis; side
// faces 0, 1, 2 (and their opposites) are at 0, 60 and 120 degrees.
typedef struct HaloRays {
  REAL3 a, b, c;   // the crystal's axes x, y and z in the world
  REAL3 at, d;     // position and direction of the light
  REAL3 sunlight;  // its original direction
  REAL index;      // of refraction
  REAL weight;     // fraction of the light that is left
  UINTS random;    // random state
} HaloRays;

// Light leaving a crystal.
typedef struct HaloExits {
  REAL3 d;      // in the crystal's coordinates
  REAL weight;  // 0: none
} HaloExits;

// Components of v along the normals of side faces 0, 1 and 2.
ALWAYS_INLINE REAL3 halo_sides(REAL3 v) {
  const REAL half_x = 0.5f * v.x, rest = 0.866025404f * v.y;
  return real3(v.x, half_x + rest, rest - half_x);
}

// a + s n with the normal n of side face `side`, or of the basal face (+z) for -1.
ALWAYS_INLINE REAL3 halo_along_normal(REAL3 a, REAL s, MASK side) {
  const MASK basal = MASK_OF(side < 0), first = MASK_OF(side == 0), second = MASK_OF(side == 1);
  const REAL x = select(select(-0.5f * s, 0.5f * s, second), s, first);
  const REAL y = select(0.866025404f * s, ALL_OF(0.0f), first), none = ALL_OF(0.0f);
  return real3(a.x + select(x, none, basal), a.y + select(y, none, basal), a.z + select(none, s, basal));
}

ALWAYS_INLINE REAL halo_sign(REAL x) { return select(ALL_OF(1.0f), ALL_OF(-1.0f), MASK_OF(x < 0.0f)); }

// Fresnel reflectance for unpolarised light, by the cosines outside and inside.
ALWAYS_INLINE REAL halo_reflectance(REAL outside, REAL inside, REAL index) {
  const REAL a = outside + index * inside, b = index * outside + inside;
  const REAL inverse = halo_inverse(a * b);
  const REAL s = (outside - index * inside) * b * inverse, p = (index * outside - inside) * a * inverse;
  return 0.5f * (s * s + p * p);
}

// Orients the crystal: rotates by `spin` about its own axis, by the tilt, and about the vertical.
ALWAYS_INLINE void halo_orient(const HaloLaunch* launch, HaloRays* rays) {
  REAL sin_spin, cos_spin, sin_tilt, cos_tilt, sin_turn, cos_turn;
  REAL spin = halo_random(&rays->random);
  if (launch->shape == HALO_RANDOM) {
    cos_tilt = 1.0f - 2.0f * halo_random(&rays->random);
    sin_tilt = halo_root(1.0f - cos_tilt * cos_tilt);
  } else {
    // Normal deviates (Box and Muller 1958): both components of a plate's tilt, one of a column's.
    const REAL far = halo_root(2.0f * halo_minus_log(halo_random(&rays->random) + 5.96046448e-8f));
    REAL first = far, second = far;
    if (launch->shape != HALO_PLATE) {
      halo_turn(halo_random(&rays->random), &sin_turn, &cos_turn);
      first = far * cos_turn;
      second = far * sin_turn;
    }
    if (launch->shape == HALO_PARRY) spin = launch->roll * second;
    halo_turn(launch->tilt * first + (launch->shape == HALO_PLATE ? 0.0f : 0.25f), &sin_tilt, &cos_tilt);
  }
  halo_turn(spin, &sin_spin, &cos_spin);
  halo_turn(halo_random(&rays->random), &sin_turn, &cos_turn);
  const REAL ahead = cos_tilt * cos_spin, aside = cos_tilt * sin_spin;
  rays->a = real3(cos_turn * ahead - sin_turn * sin_spin, sin_turn * ahead + cos_turn * sin_spin,
                  -sin_tilt * cos_spin);
  rays->b = real3(-cos_turn * aside - sin_turn * cos_spin, cos_turn * cos_spin - sin_turn * aside,
                  sin_tilt * sin_spin);
  rays->c = real3(cos_turn * sin_tilt, sin_turn * sin_tilt, cos_tilt);
}

// Light from a point of the sun's disk, in the crystal's coordinates.
ALWAYS_INLINE void halo_shine(const HaloLaunch* launch, HaloRays* rays) {
  REAL sine, cosine;
  halo_turn(halo_random(&rays->random), &sine, &cosine);
  const REAL off = launch->sun_radius * halo_root(halo_random(&rays->random));
  const REAL up = off * sine, scale = 0.0f - halo_inverse_root(1.0f + off * off);
  const REAL3 d = real3((launch->sun_x - up * launch->sun_z) * scale, off * cosine * scale,
                        (launch->sun_z + up * launch->sun_x) * scale);
  rays->sunlight = real3(halo_dot(d, rays->a), halo_dot(d, rays->b), halo_dot(d, rays->c));
}

// A point on the faces lit by the sun, sampled by projected area: the face's index (as in
// halo_along_normal()) and the lit side. Sets `at`, and the weight: the total projected area.
ALWAYS_INLINE MASK halo_pick_face(const HaloLaunch* launch, HaloRays* rays, REAL* facing) {
  const REAL h = launch->half_height + ALL_OF(0.0f);
  const REAL3 s = halo_sides(rays->sunlight);
  const REAL basal = 3.46410162f * fabs(rays->sunlight.z), edge = 2.30940108f * h;
  const REAL first = basal + edge * fabs(s.x), second = first + edge * fabs(s.y),
             all = second + edge * fabs(s.z);
  const REAL pick = all * halo_random(&rays->random);
  const REAL u = halo_random(&rays->random), v = halo_random(&rays->random);
  const MASK on_basal = MASK_OF(pick < basal), on_first = MASK_OF(pick < first),
             on_second = MASK_OF(pick < second);
  *facing = select(select(select(s.z, s.y, on_second), s.x, on_first), rays->sunlight.z, on_basal);
  const MASK side =
      select(select(select(NO_LANES + 2, NO_LANES + 1, on_second), NO_LANES, on_first), ALL_LANES, on_basal);
  // The hexagon is three rhombi about its centre; a side face is a rectangle about its normal.
  const REAL third = 3.0f * u;
  const MASK rhombus = TO_MASK(third);
  const REAL p = third - TO_REAL(rhombus), none = ALL_OF(0.0f);
  const MASK one = MASK_OF(rhombus == 1), two = MASK_OF(rhombus == 2);
  const REAL px = select(select(p - v, 0.0f - p, one), v, two);
  const REAL py = select(select(0.577350269f * (p + v), 0.577350269f * p - 1.15470054f * v, one),
                         0.577350269f * v - 1.15470054f * p, two);
  const REAL out = 0.0f - halo_sign(*facing), along = 1.15470054f * u - 0.577350269f;
  const MASK is_first = MASK_OF(side == 0), is_second = MASK_OF(side == 1);
  // The direction along a side face is perpendicular to its normal.
  const REAL tx = select(select(-0.866025404f * along, -0.866025404f * along, is_second), none, is_first);
  const REAL ty = select(select(-0.5f * along, 0.5f * along, is_second), along, is_first);
  const REAL3 start = real3(select(tx, px, on_basal), select(ty, py, on_basal),
                            select((2.0f * v - 1.0f) * h, none, on_basal));
  rays->at = halo_along_normal(start, select(out, out * h, on_basal), side);
  rays->weight = all * launch->weight;
  return side;
}

// A ray of sunlight hits a crystal: the reflected part leaves at once, the rest enters.
ALWAYS_INLINE HaloExits halo_enter(const HaloLaunch* launch, MASK ray, HaloRays* rays) {
  rays->random = halo_hash(AS_UINTS(ray) + launch->seed);
  rays->index = launch->index_low + (launch->index_high - launch->index_low) * halo_random(&rays->random);
  halo_orient(launch, rays);
  halo_shine(launch, rays);
  REAL facing;
  const MASK side = halo_pick_face(launch, rays, &facing);
  const REAL outside = fabs(facing), inverse = halo_inverse(rays->index);
  const REAL inside = halo_root(1.0f - (1.0f - outside * outside) * inverse * inverse);
  const REAL part = halo_reflectance(outside, inside, rays->index);
  HaloExits exits;
  exits.weight = rays->weight * part;
  exits.d = halo_along_normal(rays->sunlight, -2.0f * facing, side);
  const REAL3 slowed =
      real3(rays->sunlight.x * inverse, rays->sunlight.y * inverse, rays->sunlight.z * inverse);
  rays->d = halo_along_normal(slowed, halo_sign(facing) * (inside - outside * inverse), side);
  rays->weight = rays->weight - exits.weight;
  return exits;
}
