// Light inside a crystal hits its surface: a part leaves, the rest is reflected.
#pragma once
#include "lib/halo/crystal.cl"

// The next face, of the basal pair (-1) and the three pairs of sides: distances are quotients, compared by
// cross multiplication. `facing`: the direction's component along the face's normal.
ALWAYS_INLINE MASK halo_next_face(const HaloLaunch* launch, HaloRays* rays, REAL* facing) {
  const REAL3 s = halo_sides(rays->d), q = halo_sides(rays->at);
  const REAL way[3] = {s.x, s.y, s.z}, place[3] = {q.x, q.y, q.z};
  REAL gap = launch->half_height - halo_sign(rays->d.z) * rays->at.z, speed = fabs(rays->d.z);
  MASK side = ALL_LANES;
  *facing = rays->d.z;
  for (int i = 0; i < 3; ++i) {
    const REAL other_gap = 1.0f - halo_sign(way[i]) * place[i], other_speed = fabs(way[i]);
    const MASK nearer = MASK_OF(other_gap * speed < gap * other_speed);
    gap = select(gap, other_gap, nearer);
    speed = select(speed, other_speed, nearer);
    side = select(side, NO_LANES + i, nearer);
    *facing = select(*facing, way[i], nearer);
  }
  const REAL t = real_max(gap, ALL_OF(0.0f)) * halo_inverse(real_max(speed, ALL_OF(1e-6f)));
  rays->at = real3(rays->at.x + t * rays->d.x, rays->at.y + t * rays->d.y, rays->at.z + t * rays->d.z);
  return side;
}

// Moves the rays to the surface and reflects them; returns the light that leaves there. `side`: the face.
ALWAYS_INLINE HaloExits halo_bounce(const HaloLaunch* launch, HaloRays* rays, MASK* side) {
  REAL facing;
  *side = halo_next_face(launch, rays, &facing);
  const REAL inside = fabs(facing), index = rays->index;
  const REAL left = 1.0f - (1.0f - inside * inside) * index * index;  // squared cosine outside
  const MASK leaves = MASK_OF(left > 0.0f);
  const REAL outside = halo_root(select(ALL_OF(1.0f), left, leaves));
  const REAL part = select(ALL_OF(1.0f), halo_reflectance(outside, inside, index), leaves);
  HaloExits exits;
  const REAL kept = rays->weight * part;
  exits.weight = rays->weight - kept;
  const REAL3 faster = real3(rays->d.x * index, rays->d.y * index, rays->d.z * index);
  exits.d = halo_along_normal(faster, halo_sign(facing) * (outside - index * inside), *side);
  rays->d = halo_along_normal(rays->d, -2.0f * facing, *side);
  rays->weight = kept;
  return exits;
}
