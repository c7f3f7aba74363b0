// Light inside a crystal hits its surface: a part leaves, the rest is reflected.
#include "plain/halo/crystal.cl"

// Moves the ray to the next face, of the basal pair and the three pairs of sides: distances are quotients,
// compared by cross multiplication. `cos_inside`: the direction's component along the face's normal.
static inline int next_face(UNIFORM const HaloLaunch* launch, OUT CrystalRay* ray, OUT float* cos_inside) {
  const float3 s = along_sides(ray->d), q = along_sides(ray->o);
  const float way[3] = {s.x, s.y, s.z}, place[3] = {q.x, q.y, q.z};
  float gap = launch->half_height - sign_of(ray->d.z) * ray->o.z, speed = fabs(ray->d.z), along = ray->d.z;
  int face = BASAL_FACE;
  for (int i = 0; i < 3; ++i) {
    const float other_gap = 1.0f - sign_of(way[i]) * place[i], other_speed = fabs(way[i]);
    if (other_gap * speed < gap * other_speed) {
      gap = other_gap;
      speed = other_speed;
      along = way[i];
      face = i;
    }
  }
  *cos_inside = along;
  const float t = real_max(gap, 0.0f) * halo_inverse(real_max(speed, 1e-6f));
  ray->o = ray->o + ray->d * t;
  return face;
}

// Moves the ray to the surface and reflects it; returns the light that leaves there.
ENTRY static inline LeavingLight reflect_inside(UNIFORM const HaloLaunch* launch, OUT CrystalRay* ray) {
  float cos_inside;
  const float3 n = normal_of_face(next_face(launch, ray, &cos_inside));
  const float inside = fabs(cos_inside), eta = ray->eta;
  const float left = 1.0f - (1.0f - inside * inside) * eta * eta;  // squared cosine outside
  const float outside = halo_sqrt(left > 0.0f ? left : 1.0f);
  const float kept = ray->throughput * (left > 0.0f ? fresnel_dielectric(outside, inside, eta) : 1.0f);
  LeavingLight refracted;
  refracted.weight = ray->throughput - kept;
  refracted.d = ray->d * eta + n * (sign_of(cos_inside) * (outside - eta * inside));
  ray->d = ray->d + n * (-2.0f * cos_inside);
  ray->throughput = kept;
  return refracted;
}
