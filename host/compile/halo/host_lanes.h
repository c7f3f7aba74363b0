// The host's counterpart of lib/core/lanes.h: four lanes in compiler vectors. Include once, before
// kernels/lib/halo, inside its namespace.
#define SUNDOG_HOST_LANES
#define LANES 4
#define ALWAYS_INLINE [[gnu::always_inline]] inline
#define NEVER_INLINE inline

using REAL = float __attribute__((vector_size(16)));
using MASK = int __attribute__((vector_size(16)));
using UINTS = u32 __attribute__((vector_size(16)));

#define ALL_OF(x) (REAL{} + (x))
#define NO_LANES (MASK{})
#define ALL_LANES (~MASK{})
#define MASK_OF(comparison) (comparison)
#define AS_MASK(x) (reinterpret_cast<MASK>(x))
#define AS_REAL(x) (reinterpret_cast<REAL>(x))
#define AS_UINTS(x) (reinterpret_cast<UINTS>(x))
#define TO_MASK(x) __builtin_convertvector(x, MASK)
#define TO_REAL(x) __builtin_convertvector(x, REAL)
#define MASK_LANE(variable, i) (variable)[i]
#define REAL_LANE(variable, i) (variable)[i]

struct REAL3 {
  REAL x, y, z;
};
ALWAYS_INLINE REAL3 real3(REAL x, REAL y, REAL z) { return {x, y, z}; }
ALWAYS_INLINE REAL select(REAL a, REAL b, MASK m) { return m ? b : a; }
ALWAYS_INLINE MASK select(MASK a, MASK b, MASK m) { return m ? b : a; }
ALWAYS_INLINE REAL fabs(REAL x) { return AS_REAL(AS_MASK(x) & 0x7fffffff); }
ALWAYS_INLINE REAL real_min(REAL a, REAL b) { return select(b, a, a < b); }
ALWAYS_INLINE REAL real_max(REAL a, REAL b) { return select(b, a, a > b); }
ALWAYS_INLINE REAL real_clamp(REAL a, REAL low, REAL high) { return real_min(real_max(a, low), high); }
ALWAYS_INLINE bool any_lane(MASK m) { return (m[0] | m[1] | m[2] | m[3]) != 0; }

#define HALO_MAP u32*
#define HALO_ADD(map, index, units) ((map)[index] += (units))
