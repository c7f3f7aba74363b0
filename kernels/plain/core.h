// What plain kernels may call of lib/core. Vectors have operators; +, * and the others are add3, scale3, ...
#include "lib/core/tables.h"

CALLED(dot3) float dot(float3 a, float3 b);
CALLED(greatest3) float greatest(float3 a);
CALLED(length3) float length(float3 a);
CALLED(along3) float3 along(float3 a, float s, float3 b);  // a + s b
float real_min(float a, float b);
float real_max(float a, float b);

// Counts a ray of each path that is here. A ray also counts for its path's pixel.
CALLED(count_lanes) void count(UNIFORM u32* counts, UNIFORM u32 which, HERE);
CALLED(note_own_rays) void note_ray(HERE, UNIFORM u32* counts);
