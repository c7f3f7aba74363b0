// Functions of lib/core for plain kernels. Vectors have operators; +, * and the others are add3, scale3, ...
#include "lib/core/tables.h"
#include "shared/sampler.h"
#include "shared/scene.h"
#include "shared/spectra.h"

CALLED(dot3) float dot(float3 a, float3 b);
CALLED(cross3) float3 cross(float3 a, float3 b);
CALLED(greatest3) float greatest(float3 a);
CALLED(length3) float length(float3 a);
CALLED(along3) float3 along(float3 a, float s, float3 b);  // a + s b
static inline float greatest_size(float3 a) { return greatest((float3)(fabs(a.x), fabs(a.y), fabs(a.z))); }
static inline float plain_dot(float3 a, float3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
float real_min(float a, float b);
float real_max(float a, float b);
float real_clamp(float a, float low, float high);
float real_sqrt(float a);
float real_exp(float a);
float real_log(float a);
float nonzero(float a);  // to divide by

float real_rsqrt(float a);
float3 unit3(float3 a);
float3 safe_unit3(float3 a);
float3 renormalized3(float3 a);

CONSTANT int MAX_CROSSINGS;

// Counts a ray of each path that is here. A ray also counts for its path's pixel.
CALLED(count_lanes) void count(UNIFORM u32* counts, UNIFORM u32 which, HERE);
CALLED(note_own_rays) void note_ray(HERE, UNIFORM u32* counts);

// Random numbers of a pixel's sample: four of the dimensions from `dimension` on, or two of them.
typedef struct LANES(FourNumbers) {
  float x, y, z, w;
} Numbers;
typedef struct LANES(LaneSamples, join_samples) {
  int x, y, sample;
} SampleAt;
CALLED(wanted_lanes)
Numbers numbers_at(const SampleAt* at, int dimension, UNIFORM bool first, UNIFORM bool later);

// The spectrum whose rows begin at `first`, at a wavelength: a (fractional) row of the table.
HAVING(HAS_DISPERSION)
static inline float spectrum_at(UNIFORM const Scene* scene, UNIFORM u32 first, float row) {
  const int low = min((int)row, (int)SPECTRUM_ROWS - 2), at = (int)first + low;
  const float a = scene->spectra[at], b = scene->spectra[at + 1];
  return fma(row - (float)low, b - a, a);
}
