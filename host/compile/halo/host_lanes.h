// The host's counterpart of lib/core/lanes.h: four lanes in compiler vectors. Include once, inside a
// namespace, before kernels/plain/halo in lanes.
#define LANES 4
#define ALWAYS_INLINE [[gnu::always_inline]] inline
#define NEVER_INLINE static
#define __global

template <class T>
struct VectorOf;  // named here, since a template's own vectors of T would not be the compiler's
template <>
struct VectorOf<float> {
  using Type = float __attribute__((vector_size(4 * LANES)));
};
template <>
struct VectorOf<int> {
  using Type = int __attribute__((vector_size(4 * LANES)));
};
template <>
struct VectorOf<u32> {
  using Type = u32 __attribute__((vector_size(4 * LANES)));
};

template <class T>
struct Lanes {
  using Vector = typename VectorOf<T>::Type;
  Lanes() = default;
  ALWAYS_INLINE Lanes(T all) : v(Vector{} + all) {}
  ALWAYS_INLINE Lanes(Vector each) : v(each) {}
  ALWAYS_INLINE Lanes operator-() const { return -v; }
  ALWAYS_INLINE Lanes operator~() const { return ~v; }
#define SUNDOG_OPERATOR(sign) \
  ALWAYS_INLINE friend Lanes operator sign(Lanes a, Lanes b) { return a.v sign b.v; }
  SUNDOG_OPERATOR(+)
  SUNDOG_OPERATOR(-)
  SUNDOG_OPERATOR(*)
  SUNDOG_OPERATOR(&)
  SUNDOG_OPERATOR(^)
  SUNDOG_OPERATOR(<<)
#undef SUNDOG_OPERATOR
#define SUNDOG_OPERATOR(sign) \
  ALWAYS_INLINE friend Lanes<int> operator sign(Lanes a, Lanes b) { return a.v sign b.v; }
  SUNDOG_OPERATOR(<)
  SUNDOG_OPERATOR(>)
  SUNDOG_OPERATOR(<=)
  SUNDOG_OPERATOR(>=)
  SUNDOG_OPERATOR(==)
  SUNDOG_OPERATOR(!=)
#undef SUNDOG_OPERATOR
  ALWAYS_INLINE Lanes operator>>(Lanes<int> by) const { return v >> reinterpret_cast<Vector>(by.v); }
  ALWAYS_INLINE Lanes& operator&=(Lanes b) { return *this = *this & b; }
  Vector v;
};
using REAL = Lanes<float>;
using MASK = Lanes<int>;
using UINTS = Lanes<u32>;

#define NO_LANES MASK(0)
#define ALL_LANES MASK(-1)
#define MASK_OF(comparison) (comparison)
#define AS_MASK(x) MASK(reinterpret_cast<MASK::Vector>((x).v))
#define AS_REAL(x) REAL(reinterpret_cast<REAL::Vector>((x).v))
#define AS_UINTS(x) UINTS(reinterpret_cast<UINTS::Vector>((x).v))
#define TO_MASK(x) MASK(__builtin_convertvector((x).v, MASK::Vector))
#define TO_REAL(x) REAL(__builtin_convertvector((x).v, REAL::Vector))

struct REAL3 {
  REAL x, y, z;
};
ALWAYS_INLINE REAL3 real3(REAL x, REAL y, REAL z) { return {x, y, z}; }
ALWAYS_INLINE REAL3 add3(REAL3 a, REAL3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
ALWAYS_INLINE REAL3 scale3(REAL3 a, REAL s) { return {a.x * s, a.y * s, a.z * s}; }
template <class T>
ALWAYS_INLINE Lanes<T> select(Lanes<T> a, Lanes<T> b, MASK m) {
  return m.v ? b.v : a.v;
}
ALWAYS_INLINE REAL3 select3(REAL3 a, REAL3 b, MASK m) {
  return {select(a.x, b.x, m), select(a.y, b.y, m), select(a.z, b.z, m)};
}
ALWAYS_INLINE REAL fabs(REAL x) { return AS_REAL((AS_MASK(x) & 0x7fffffff)); }
ALWAYS_INLINE REAL real_min(REAL a, REAL b) { return select(b, a, a < b); }
ALWAYS_INLINE REAL real_max(REAL a, REAL b) { return select(b, a, a > b); }
ALWAYS_INLINE REAL real_clamp(REAL a, REAL low, REAL high) { return real_min(real_max(a, low), high); }
ALWAYS_INLINE bool any_lane(MASK m) {
  using Halves = long long __attribute__((vector_size(4 * LANES)));
  const Halves halves = reinterpret_cast<Halves>(m.v);
  return (halves[0] | halves[1]) != 0;
}

static void add_to_cells(u32* map, MASK cell, MASK units, MASK lanes) {
  for (int i = 0; i < LANES; ++i)
    if (lanes.v[i]) map[cell.v[i]] += static_cast<u32>(units.v[i]);
}
