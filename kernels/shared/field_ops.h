// Operations in the code of distance fields. The host prints each as OpenCL C
// (host/compile/fields/field_code.cpp) or encodes it for the interpreter lib/sdf/interpret.cl. This list
// defines both, so both give the same bits.
//   OP(name, expression of the operands)
// Operands: A, B, C, D numbers; MA, MB, MC masks; PA, PB, PC, PD points; SA, SB samples; T a number of the
// table, Q the table from there; N a whole number; I the iteration; K the cell of a repetition.
#pragma once
#include "shared/types.h"
SUNDOG_SHARED_BEGIN

// A table:
// clang-format off
#define FIELD_OPS(REAL_OP, MASK_OP, POINT_OP, SAMPLE_OP)                \
  REAL_OP(COPY, A)                                                      \
  REAL_OP(ADD, A + B)                                                   \
  REAL_OP(SUBTRACT, A - B)                                              \
  REAL_OP(MULTIPLY, A * B)                                              \
  REAL_OP(DIVIDE, A / B)                                                \
  REAL_OP(FMA, fma(A, B, C))                                            \
  REAL_OP(FMA_LESS_A, fma(-A, B, C))                                    \
  REAL_OP(FMA_LESS_C, fma(A, B, -C))                                    \
  REAL_OP(NEGATE, -A)                                                   \
  REAL_OP(ABSOLUTE, fabs(A))                                            \
  REAL_OP(MINIMUM, real_min(A, B))                                      \
  REAL_OP(MAXIMUM, real_max(A, B))                                      \
  REAL_OP(ROUND_DOWN, floor(A))                                         \
  REAL_OP(SQUARE_ROOT, real_sqrt(A))                                    \
  REAL_OP(INVERSE_ROOT, inverse_root_power(A, N))                       \
  REAL_OP(ROUGH_INVERSE_ROOT, rough_rsqrt(A))                           \
  REAL_OP(SINE, real_sin(A))                                            \
  REAL_OP(COSINE, real_cos(A))                                          \
  REAL_OP(ARC_COSINE, acos(A))                                          \
  REAL_OP(ARC_TANGENT, atan2(A, B))                                     \
  REAL_OP(EXPONENTIAL, exp(A))                                          \
  REAL_OP(LOGARITHM, real_log(A))                                       \
  REAL_OP(POWER, pow(A, B))                                             \
  REAL_OP(CHOOSE, select(A, B, MC))                                     \
  MASK_OP(COPY_MASK, MA)                                                \
  MASK_OP(LESS, MASK_OF(A < B))                                         \
  MASK_OP(LESS_EQUAL, MASK_OF(A <= B))                                  \
  MASK_OP(BOTH, MA & MB)                                                \
  MASK_OP(EITHER, MA | MB)                                              \
  MASK_OP(OPPOSITE, ~MA)                                                \
  /* of orbits */                                                       \
  REAL_OP(ITERATION, (REAL)((float)I))                                  \
  MASK_OP(LATE, I == (u32)T ? MA : NO_LANES)                            \
  REAL_OP(SQUARE_LENGTH3, square_length3(A, B, C))                      \
  REAL_OP(SQUARE_LENGTH4, square_length4(A, B, C, D))                   \
  REAL_OP(AXIS_DISTANCE, axis_distance(A, B, C))                        \
  REAL_OP(STRETCH, stretch_of(PA, PB, PC, PD))                          \
  REAL_OP(LOGARITHMIC, logarithmic_distance(A, B, C))                   \
  REAL_OP(LINEAR, linear_distance(A, B, C))                             \
  REAL_OP(CLAMPED, clamp(A, (REAL)(0.0f), (REAL)(1.0f)))                \
  REAL_OP(FINITE, finite_distance(A))                                   \
  POINT_OP(SCALE, scale3(PA, B))                                        \
  POINT_OP(UNIT, unit3(PA))                                             \
  /* of fields put together */                                          \
  POINT_OP(INTO_CHILD, into_child(PA, Q))                               \
  REAL_OP(OUT_OF_CHILD, out_of_child_distance(A, Q))                    \
  SAMPLE_OP(OUT_OF_CHILD_SAMPLE, out_of_child_sample(SA, Q))            \
  POINT_OP(REPEAT_CELL, repeat_cell(PA, Q, K))                          \
  REAL_OP(UNITE_CELLS, unite(A, B, 0.0f))                               \
  SAMPLE_OP(UNITE_CELLS_SAMPLES, unite_samples(SA, SB, 0.0f))           \
  REAL_OP(UNITE, unite(A, B, T))                                        \
  SAMPLE_OP(UNITE_SAMPLES, unite_samples(SA, SB, T))                    \
  REAL_OP(INTERSECT, intersect(A, B, T))                                \
  SAMPLE_OP(INTERSECT_SAMPLES, intersect_samples(SA, SB, T))            \
  REAL_OP(SUBTRACT_FROM, subtract_from(A, B, T))                        \
  SAMPLE_OP(SUBTRACT_SAMPLES, subtract_samples(SA, SB, T))              \
  REAL_OP(THICKEN, thicken(A, T))                                       \
  SAMPLE_OP(THICKEN_SAMPLE, thicken_sample(SA, T))                      \
  REAL_OP(SHELL, shell(A, T))                                           \
  SAMPLE_OP(SHELL_SAMPLE, shell_sample(SA, T))                          \
  SAMPLE_OP(NO_SAMPLE, no_sample())                                     \
  REAL_OP(NEAR_DISTANCE, near_distance(SA))
// clang-format on

#define SUNDOG_FIELD_OP(name, expression) FIELD_##name,
enum FieldOp SUNDOG_ENUM_OF_U32 {
  FIELD_OPS(SUNDOG_FIELD_OP, SUNDOG_FIELD_OP, SUNDOG_FIELD_OP, SUNDOG_FIELD_OP)
  // Operations of programs only. `x` is the instruction's second word.
  FIELD_LITERAL,  // result: x as the bits of a float
  FIELD_NUMBER,   // result: entry x of the table
  FIELD_START,    // counter d = 0
  FIELD_MODULO,   // counter d = counter named by the result's byte, modulo x
  FIELD_NEXT,     // increments counter d; jumps to x
  FIELD_JUMP,     // jumps to x
  FIELD_WHILE,    // jumps to the low half of x if counter d has reached the table entry at the high half
  FIELD_BELOW,    // likewise, if it has reached the high half itself
  FIELD_SKIP,     // likewise, if it has one of the bits of the high half
  FIELD_LEAVE,    // jumps to x if no lane of mask A is set
  FIELD_END       // returns A
};
#undef SUNDOG_FIELD_OP

// An instruction is two words: op, result, A, B, one byte each from the lowest; then C, D or a counter, and
// in the high half T, Q or N; or x. Numbers and masks use one register, points three, samples eight. The
// field's point and the active lanes are passed in the first four.
#define FIELD_REGISTERS 128u
#define FIELD_COUNTERS 20u
#define FIELD_ACTIVE 3u
// The table's first word is the offset of the programs in it, 0 without any. There, four words per field give
// the start of each function: distance, signed distance, sample, and near (0 if the field has none).
#define FIELD_FUNCTIONS 4u

SUNDOG_SHARED_END
