// The map of the sky: the sphere on a square with cells of equal area (Clarberg, "Fast Equal-Area Mapping of
// the (Hemi)Sphere using SIMD", 2008); the upper half is the inner diamond.
#include "plain/halo/numbers.cl"

// The cell of the direction d, from the ground towards the light.
static inline int equal_area_cell(float3 d, UNIFORM u32 side) {
  const float x = fabs(d.x), y = fabs(d.y), z = fabs(d.z);
  const bool swapped = x < y, below = d.z < 0.0f;
  const float greater = swapped ? y : x, smaller = swapped ? x : y;
  const float radius = halo_sqrt((x * x + y * y) * halo_inverse(1.0f + z));
  const float b = smaller * halo_inverse(real_max(greater, 1e-20f)), w = b * b;
  // Arc tangent in quarter turns, fitted to 1e-6.
  const float angle =
      b * (0.63660693f +
           w * (-0.21177506f + w * (0.12329435f + w * (-0.07426241f + w * (0.03362848f - w * 0.00749333f)))));
  const float turned = (swapped ? 1.0f - angle : angle) * radius, rest = radius - turned;
  const float u = below ? 1.0f - turned : rest, v = below ? 1.0f - rest : turned;
  const float half_side = 0.5f * (float)side, most = (float)side - 0.5f;
  const float column = half_side + half_side * u * sign_of(d.x),
              row = half_side + half_side * v * sign_of(d.y);
  return (int)real_clamp(row, 0.0f, most) * (int)side + (int)real_clamp(column, 0.0f, most);
}
