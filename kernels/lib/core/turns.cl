// Rotation and scaling of instances about points while the shutter is open, backward to when it opened and
// forward from then; one row of `turns` at a time.
#pragma once
#include "lib/core/lanes.h"
#include "shared/bvh.h"

#if HAS_TURNS
// Sine, and 1 minus cosine, of fractions of a turn. Polynomials, because one lane can make a built-in take a
// slower path for all.
typedef struct TurnedParts {
  REAL sine, rest;
} TurnedParts;

// sin(pi x) for x in [-1/2, 1/2]: Taylor series.
static inline REAL sine_of_half_turns(REAL x) {
  const REAL y = M_PI_F * x, s = y * y;
  REAL sum = fma(s, (REAL)(-1.0f / 39916800.0f), (REAL)(1.0f / 362880.0f));
  sum = fma(s, sum, (REAL)(-1.0f / 5040.0f));
  sum = fma(s, sum, (REAL)(1.0f / 120.0f));
  sum = fma(s, sum, (REAL)(-1.0f / 6.0f));
  return fma(y * s, sum, y);
}

static inline TurnedParts turned_parts(REAL turns) {
  const REAL part = turns - floor(turns + 0.5f);
  const REAL sine = sine_of_half_turns(part), cosine = sine_of_half_turns(0.5f - fabs(part));
  const TurnedParts parts = {2.0f * sine * cosine, 2.0f * sine * sine};
  return parts;
}

static inline REAL3 spin3(__global const Turn* turn, REAL3 a) {
  return real3(dot3(all3(turn->spin[0].xyz), a), dot3(all3(turn->spin[1].xyz), a),
               dot3(all3(turn->spin[2].xyz), a));
}
static inline REAL3 spin_normal3(__global const Turn* turn, REAL3 n) {
  return along3(along3(scale3(all3(turn->spin[0].xyz), n.x), n.y, all3(turn->spin[1].xyz)), n.z,
                all3(turn->spin[2].xyz));
}
static inline REAL3 pivot_of(__global const Turn* turn) {
  return all3((float3)(turn->spin[0].w, turn->spin[1].w, turn->spin[2].w));
}
// The scale at a time.
static inline REAL size_at(__global const Turn* turn, REAL time) {
  return fma(time, (REAL)(turn->turn.y), (REAL)(1.0f));
}

static inline REAL3 turn_back(__global const Turn* turn, REAL3 a, REAL time) {
  const TurnedParts parts = turned_parts(time * turn->turn.x);
  const REAL3 once = spin3(turn, a), twice = spin3(turn, once);
  return scale3(along3(along3(a, -parts.sine, once), parts.rest, twice), 1.0f / size_at(turn, time));
}
static inline REAL3 turn_on(__global const Turn* turn, REAL3 a, REAL time) {
  const TurnedParts parts = turned_parts(time * turn->turn.x);
  const REAL3 once = spin3(turn, a), twice = spin3(turn, once);
  return scale3(along3(along3(a, parts.sine, once), parts.rest, twice), size_at(turn, time));
}
// Normals are covectors: multiplied by the transpose of turn_back().
static inline REAL3 turn_normal(__global const Turn* turn, REAL3 n, REAL time) {
  const TurnedParts parts = turned_parts(time * turn->turn.x);
  const REAL3 once = spin_normal3(turn, n), twice = spin_normal3(turn, once);
  return scale3(along3(along3(n, -parts.sine, once), parts.rest, twice), 1.0f / size_at(turn, time));
}

// An instance's rows, by its row of `moves`: `first` to `end`.
static inline u32 first_turn(float4 moves) { return moves.w > 0.0f ? (u32)moves.w - 1u : 0u; }
static inline u32 end_of_turns(__global const Turn* turns, float4 moves) {
  return moves.w > 0.0f ? (u32)moves.w + (u32)turns[first_turn(moves)].turn.z : 0u;
}

NEVER_INLINE REAL3 unturned_points(__global const Turn* turns, float4 moves, REAL3 p, REAL time) {
  REAL3 still = along3(p, -time, all3(moves.xyz));
  const u32 end = end_of_turns(turns, moves);
  for (u32 i = first_turn(moves); i < end; ++i) {
    const REAL3 pivot = pivot_of(turns + i);
    still = add3(pivot, turn_back(turns + i, subtract3(still, pivot), time));
    still = along3(still, -time, all3(turns[i].moves.xyz));
  }
  return still;
}
static inline REAL3 unturned_vectors(__global const Turn* turns, float4 moves, REAL3 a, REAL time) {
  REAL3 still = a;
  const u32 end = end_of_turns(turns, moves);
  for (u32 i = first_turn(moves); i < end; ++i) still = turn_back(turns + i, still, time);
  return still;
}
static inline REAL3 turned_normals(__global const Turn* turns, float4 moves, REAL3 n, REAL time) {
  REAL3 moved = n;
  const u32 first = first_turn(moves);
  for (u32 i = end_of_turns(turns, moves); i > first; --i) moved = turn_normal(turns + i - 1u, moved, time);
  return moved;
}
static inline REAL3 turned_vectors(__global const Turn* turns, float4 moves, REAL3 a, REAL time) {
  REAL3 moved = a;
  const u32 first = first_turn(moves);
  for (u32 i = end_of_turns(turns, moves); i > first; --i) moved = turn_on(turns + i - 1u, moved, time);
  return moved;
}
static inline REAL turned_size(__global const Turn* turns, float4 moves, REAL time) {
  REAL size = (REAL)(1.0f);
  const u32 end = end_of_turns(turns, moves);
  for (u32 i = first_turn(moves); i < end; ++i) size *= size_at(turns + i, time);
  return size;
}
static inline float turned_extent(__global const Turn* turns, float4 moves) {
  return moves.w > 0.0f ? turns[first_turn(moves)].turn.w : 0.0f;
}
#endif
