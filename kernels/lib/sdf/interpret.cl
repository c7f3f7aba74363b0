// Interprets the fields of any scene by programs in their parameter table (host/compile/fields/
// field_program.h). Draws after an edit of a formula until its own kernel is built; replaces
// generated/sdf.cl, with the same bits.
#pragma once
#include "lib/sdf/compose.cl"
#include "shared/field_ops.h"

#define SDF_HAS_NEAR 1

static inline REAL3 point_at(const REAL* r) { return real3(r[0], r[1], r[2]); }
static inline void put_point(REAL* r, REAL3 p) {
  r[0] = p.x;
  r[1] = p.y;
  r[2] = p.z;
}
static inline SdfSample sample_at(const REAL* r) {
  const SdfSample s = {r[0], {r[1], r[2], r[3]}, r[4], r[5], r[6], r[7]};
  return s;
}
static inline void put_sample(REAL* r, SdfSample s) {
  r[0] = s.distance;
  put_point(r + 1, s.gradient);
  r[4] = s.point;
  r[5] = s.plane;
  r[6] = s.axis;
  r[7] = s.iterations;
}

// Operands of an instruction with words w and x.
#define A r[w >> 16 & 255u]
#define B r[w >> 24]
#define C r[x & 255u]
#define D r[x >> 8 & 255u]
#define MA AS_MASK(A)
#define MB AS_MASK(B)
#define MC AS_MASK(C)
#define PA point_at(&A)
#define PB point_at(&B)
#define PC point_at(&C)
#define PD point_at(&D)
#define SA sample_at(&A)
#define SB sample_at(&B)
#define T q[x >> 16]
#define Q q + (x >> 16)
#define N (int)(x >> 16)
#define I counters[x >> 8 & 255u]
#define K counters[x >> 8 & 255u]
#define RESULT r[w >> 8 & 255u]
#define COUNTER counters[w >> 8 & 255u]

#define REAL_CASE(name, expression) \
  case FIELD_##name:                \
    RESULT = expression;            \
    break;
#define MASK_CASE(name, expression) \
  case FIELD_##name:                \
    RESULT = AS_REAL(expression);   \
    break;
#define POINT_CASE(name, expression) \
  case FIELD_##name:                 \
    put_point(&RESULT, expression);  \
    break;
#define SAMPLE_CASE(name, expression) \
  case FIELD_##name:                  \
    put_sample(&RESULT, expression);  \
    break;

// Runs the function at word `start` of the table on the registers; returns the register of its result. A
// single exit: llvmpipe mixes up registers of lanes if some return from the loop while others stay.
NEVER_INLINE u32 run_program(__global const float* restrict q, u32 start, REAL* r) {
  __global const u32* program = (__global const u32*)q + start;
  u32 counters[FIELD_COUNTERS];
  u32 at = 0, w = program[0];
  while ((w & 255u) != FIELD_END) {
    const u32 x = program[2u * at + 1u];
    switch (w & 255u) {
      FIELD_OPS(REAL_CASE, MASK_CASE, POINT_CASE, SAMPLE_CASE)
      case FIELD_LITERAL:
        RESULT = (REAL)(as_float(x));
        break;
      case FIELD_NUMBER:
        RESULT = (REAL)(q[x]);
        break;
      case FIELD_START:
        COUNTER = 0u;
        break;
      case FIELD_MODULO:
        COUNTER = counters[w >> 16 & 255u] % x;
        break;
      case FIELD_NEXT:
        ++COUNTER;
        at = x - 1u;
        break;
      case FIELD_JUMP:
        at = x - 1u;
        break;
      case FIELD_WHILE:
        if (COUNTER >= (u32)T) at = (x & 0xFFFFu) - 1u;
        break;
      case FIELD_BELOW:
        if (COUNTER >= x >> 16) at = (x & 0xFFFFu) - 1u;
        break;
      case FIELD_SKIP:
        if (COUNTER & x >> 16) at = (x & 0xFFFFu) - 1u;
        break;
      case FIELD_LEAVE:
        if (!any_lane(MA)) at = x - 1u;
        break;
    }
    ++at;
    w = program[2u * at];
  }
  return w >> 16 & 255u;
}
#undef A
#undef B
#undef C
#undef D
#undef MA
#undef MB
#undef MC
#undef PA
#undef PB
#undef PC
#undef PD
#undef SA
#undef SB
#undef T
#undef Q
#undef N
#undef I
#undef K
#undef RESULT
#undef COUNTER

// Start of a field's function, 0 if it has none.
static inline u32 program_of(u32 field, u32 function, __global const float* restrict q) {
  __global const u32* words = (__global const u32*)q;
  const u32 programs = words[0], begin = words[programs + field * FIELD_FUNCTIONS + function];
  return begin ? programs + begin : 0u;
}
static inline u32 run_field(u32 field, u32 function, REAL3 p, MASK active, __global const float* restrict q,
                            REAL* r) {
  put_point(r, p);
  r[FIELD_ACTIVE] = AS_REAL(active);
  return run_program(q, program_of(field, function, q), r);
}

static inline REAL sdf_distance(u32 field, REAL3 p, MASK active, __global const float* restrict q) {
  REAL r[FIELD_REGISTERS];
  return r[run_field(field, 0u, p, active, q, r)];
}
static inline REAL sdf_signed(u32 field, REAL3 p, MASK active, __global const float* restrict q) {
  REAL r[FIELD_REGISTERS];
  return r[run_field(field, 1u, p, active, q, r)];
}
static inline SdfSample sdf_sample(u32 field, REAL3 p, __global const float* restrict q) {
  REAL r[FIELD_REGISTERS];
  const u32 at = run_field(field, 2u, p, ALL_LANES, q, r);
  return sample_at(r + at);
}
static inline bool sdf_uneven(u32 field, __global const float* restrict q) {
  return program_of(field, 3u, q) != 0u;
}
static inline REAL sdf_near(u32 field, REAL3 p, MASK active, __global const float* restrict q) {
  REAL r[FIELD_REGISTERS];
  return r[run_field(field, sdf_uneven(field, q) ? 3u : 1u, p, active, q, r)];
}
