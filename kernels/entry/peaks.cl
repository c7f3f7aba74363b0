// Kernels that do one thing as fast as a device can, for `sundog bench roofline`: read, copy, compute, start.
// All values are small whole numbers, so results are exact in every type and the host knows them.
#include "lib/core/config.h"
#include "shared/types.h"

// The type of a value; vectors have WIDTH of them. CHAINS computations that do not depend on each other.
#ifndef SCALAR
#define SCALAR float
#endif
#ifndef WIDTH
#define WIDTH 4
#endif
#ifndef CHAINS
#define CHAINS 2
#endif
#ifdef IS_HALF
#pragma OPENCL EXTENSION cl_khr_fp16 : enable
#endif
#ifdef IS_INT
#define MULTIPLY_ADD(a, b, c) ((a) * (b) + (c))
#else
#define MULTIPLY_ADD(a, b, c) fma(a, b, c)
#endif
#define JOINED(a, b) a##b
#define VECTOR(scalar, width) JOINED(scalar, width)
#if WIDTH == 1
typedef SCALAR Values;
typedef float Floats;
#else
typedef VECTOR(SCALAR, WIDTH) Values;
typedef VECTOR(float, WIDTH) Floats;
#endif

// first, first + 1, ...
static inline Values ascending(u32 first) {
  Values values;
  SCALAR* lanes = (SCALAR*)&values;
  for (u32 i = 0; i < WIDTH; ++i) lanes[i] = (SCALAR)(first + i);
  return values;
}

static inline i32 sum_of_values(Values values) {
  const SCALAR* lanes = (const SCALAR*)&values;
  i32 sum = 0;
  for (u32 i = 0; i < WIDTH; ++i) sum += (i32)lanes[i];
  return sum;
}

static inline i32 sum_of_floats(Floats values) {
  const float* lanes = (const float*)&values;
  i32 sum = 0;
  for (u32 i = 0; i < WIDTH; ++i) sum += (i32)lanes[i];
  return sum;
}

#define READS 16u
// Reads READS vectors a work-item and writes their sum plus `run`. Groups read parts of `values` one after
// another, and begin again after `parts` of them.
__kernel void read_values(__global const float* restrict values, __global i32* restrict sums, u32 parts,
                          i32 run) {
  __global const Floats* at =
      (__global const Floats*)values + get_group_id(0) % parts * get_local_size(0) * READS + get_local_id(0);
  Floats sum = (Floats)(0.0f);
#pragma unroll
  for (u32 i = 0; i < READS; ++i) sum += at[i * get_local_size(0)];
  sums[get_global_id(0)] = sum_of_floats(sum) + run;
}

// Copies a vector a work-item, and adds `run` to it.
__kernel void copy_values(__global const float* restrict values, __global float* restrict copies, i32 run) {
  const size_t item = get_global_id(0);
  ((__global Floats*)copies)[item] = ((__global const Floats*)values)[item] + (float)run;
}

#define STEPS 8u
// (x, y) -> (x f + y, y f + x f + y), STEPS times a round: 4 operations a step, each after the one before it.
// With f = -1, three steps lead back to the beginning. Writes the sum of all y plus `run`.
__kernel void multiply_and_add(__global i32* restrict sums, i32 factor, u32 rounds, i32 run) {
  const u32 item = (u32)get_global_id(0);
  const Values f = (Values)((SCALAR)factor);
  Values x[CHAINS], y[CHAINS];
  for (u32 c = 0; c < CHAINS; ++c) x[c] = ascending((item & 7u) + c), y[c] = ascending(item >> 3 & 7u);
  for (u32 round = 0; round < rounds; ++round)
#pragma unroll
    for (u32 step = 0; step < STEPS; ++step)
#pragma unroll
      for (u32 c = 0; c < CHAINS; ++c) {
        x[c] = MULTIPLY_ADD(x[c], f, y[c]);
        y[c] = MULTIPLY_ADD(y[c], f, x[c]);
      }
  i32 sum = run;
  for (u32 c = 0; c < CHAINS; ++c) sum += sum_of_values(y[c]);
  sums[item] = sum;
}

// Writes `run`, by one work-item.
__kernel void start(__global i32* restrict sums, i32 run) {
  if (get_global_id(0) == 0) sums[0] = run;
}
