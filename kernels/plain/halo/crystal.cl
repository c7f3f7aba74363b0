// Hexagonal ice prisms in sunlight: their orientation, and where a ray enters.
#include "plain/halo/numbers.cl"

// Light in a crystal. All but the axes is in the crystal's coordinates: z is its axis; side faces 0, 1, 2
// (and their opposites) are at 0, 60 and 120 degrees.
typedef struct CrystalRay {
  float3 x, y, z;    // the crystal's axes in the world
  float3 o, d;       // position and direction of the light
  float3 sunlight;   // its original direction
  float eta;         // the refractive index of ice
  float throughput;  // fraction of the light that is left
  u32 random;        // random state
} CrystalRay;

// Light leaving a crystal; in its coordinates.
typedef struct LeavingLight {
  float3 d;
  float weight;  // 0: none
} LeavingLight;

#define BASAL_FACE (-1)

// Components of v along the normals of side faces 0, 1 and 2.
static inline float3 along_sides(float3 v) {
  const float half_x = 0.5f * v.x, rest = 0.866025404f * v.y;
  return (float3)(v.x, half_x + rest, rest - half_x);
}

static inline float3 normal_of_face(int face) {
  return (float3)(face == BASAL_FACE ? 0.0f
                  : face == 0        ? 1.0f
                  : face == 1        ? 0.5f
                                     : -0.5f,
                  face <= 0 ? 0.0f : 0.866025404f, face == BASAL_FACE ? 1.0f : 0.0f);
}

// Fresnel reflectance for unpolarised light, by the cosines outside and inside.
static inline float fresnel_dielectric(float cos_outside, float cos_inside, float eta) {
  const float a = cos_outside + eta * cos_inside, b = eta * cos_outside + cos_inside;
  const float inverse = halo_inverse(a * b);
  const float s = (cos_outside - eta * cos_inside) * b * inverse,
              p = (eta * cos_outside - cos_inside) * a * inverse;
  return 0.5f * (s * s + p * p);
}

// Orients the crystal: rotates by `spin` about its own axis, by the tilt, and about the vertical.
static inline void sample_orientation(UNIFORM const HaloLaunch* launch, OUT CrystalRay* ray) {
  float sin_spin, cos_spin, sin_tilt, cos_tilt, sin_turn, cos_turn;
  float spin = halo_random(&ray->random);
  if (launch->shape == HALO_RANDOM) {
    cos_tilt = 1.0f - 2.0f * halo_random(&ray->random);
    sin_tilt = halo_sqrt(1.0f - cos_tilt * cos_tilt);
  } else {
    // Normal deviates (Box and Muller 1958): both components of a plate's tilt, one of a column's.
    const float far = halo_sqrt(2.0f * halo_minus_log(halo_random(&ray->random) + 5.96046448e-8f));
    float first = far, second = far;
    if (launch->shape != HALO_PLATE) {
      halo_sincos(halo_random(&ray->random), &sin_turn, &cos_turn);
      first = far * cos_turn;
      second = far * sin_turn;
    }
    if (launch->shape == HALO_PARRY) spin = launch->roll * second;
    halo_sincos(launch->tilt * first + (launch->shape == HALO_PLATE ? 0.0f : 0.25f), &sin_tilt, &cos_tilt);
  }
  halo_sincos(spin, &sin_spin, &cos_spin);
  halo_sincos(halo_random(&ray->random), &sin_turn, &cos_turn);
  const float ahead = cos_tilt * cos_spin, aside = cos_tilt * sin_spin;
  ray->x = (float3)(cos_turn * ahead - sin_turn * sin_spin, sin_turn * ahead + cos_turn * sin_spin,
                    -sin_tilt * cos_spin);
  ray->y = (float3)(-cos_turn * aside - sin_turn * cos_spin, cos_turn * cos_spin - sin_turn * aside,
                    sin_tilt * sin_spin);
  ray->z = (float3)(cos_turn * sin_tilt, sin_turn * sin_tilt, cos_tilt);
}

// Light from a point of the sun's disk.
static inline void sample_sun(UNIFORM const HaloLaunch* launch, OUT CrystalRay* ray) {
  float sine, cosine;
  halo_sincos(halo_random(&ray->random), &sine, &cosine);
  const float off = launch->sun_radius * halo_sqrt(halo_random(&ray->random));
  const float up = off * sine, scale = -halo_rsqrt(1.0f + off * off);
  const float3 d =
      (float3)(launch->sun_x - up * launch->sun_z, off * cosine, launch->sun_z + up * launch->sun_x) * scale;
  ray->sunlight = (float3)(halo_dot(d, ray->x), halo_dot(d, ray->y), halo_dot(d, ray->z));
}

// A point of the hexagon: one of three rhombi about its centre.
static inline float3 sample_hexagon(float u, float v) {
  const int rhombus = (int)(3.0f * u);
  const float p = 3.0f * u - (float)rhombus;
  return (float3)(rhombus == 2   ? v
                  : rhombus == 1 ? -p
                                 : p - v,
                  rhombus == 2   ? 0.577350269f * v - 1.15470054f * p
                  : rhombus == 1 ? 0.577350269f * p - 1.15470054f * v
                                 : 0.577350269f * (p + v),
                  0.0f);
}

// A point on the faces lit by the sun, sampled by projected area. Sets `o` and the throughput: the total
// projected area. Returns the face; `cos_sun`: the sunlight's component along its normal.
static inline int sample_face(UNIFORM const HaloLaunch* launch, OUT CrystalRay* ray, OUT float* cos_sun) {
  const float h = launch->half_height;
  const float3 s = along_sides(ray->sunlight);
  const float basal = 3.46410162f * fabs(ray->sunlight.z), edge = 2.30940108f * h;
  const float first = basal + edge * fabs(s.x), second = first + edge * fabs(s.y),
              all = second + edge * fabs(s.z);
  const float pick = all * halo_random(&ray->random);
  const float u = halo_random(&ray->random), v = halo_random(&ray->random);
  const bool on_basal = pick < basal;
  const int face = on_basal ? BASAL_FACE : pick < first ? 0 : pick < second ? 1 : 2;
  *cos_sun = on_basal ? ray->sunlight.z : pick < first ? s.x : pick < second ? s.y : s.z;
  const float3 n = normal_of_face(face);
  // A side face is a rectangle; its direction along the hexagon is perpendicular to its normal.
  const float out = -sign_of(*cos_sun), along = 1.15470054f * u - 0.577350269f;
  const float3 from =
      on_basal ? sample_hexagon(u, v) : (float3)(-n.y * along, n.x * along, (2.0f * v - 1.0f) * h);
  ray->o = from + n * (on_basal ? out * h : out);
  ray->throughput = all * launch->weight;
  return face;
}

// A ray of sunlight hits a crystal: the reflected part leaves at once, the rest enters.
ENTRY static inline LeavingLight enter_crystal(UNIFORM const HaloLaunch* launch, u32 index,
                                               OUT CrystalRay* ray) {
  ray->random = halo_hash(index + launch->seed);
  ray->eta = launch->index_low + (launch->index_high - launch->index_low) * halo_random(&ray->random);
  sample_orientation(launch, ray);
  sample_sun(launch, ray);
  float cos_sun;
  const float3 n = normal_of_face(sample_face(launch, ray, &cos_sun));
  const float outside = fabs(cos_sun), inverse = halo_inverse(ray->eta);
  const float inside = halo_sqrt(1.0f - (1.0f - outside * outside) * inverse * inverse);
  LeavingLight reflected;
  reflected.weight = ray->throughput * fresnel_dielectric(outside, inside, ray->eta);
  reflected.d = ray->sunlight + n * (-2.0f * cos_sun);
  ray->d = ray->sunlight * inverse + n * (sign_of(cos_sun) * (inside - outside * inverse));
  ray->throughput = ray->throughput - reflected.weight;
  return reflected;
}
