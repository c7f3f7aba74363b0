// Halos: what the host tells the kernel that traces light through ice crystals, and what it counts.
#ifndef SUNDOG_SHARED_HALO_H
#define SUNDOG_SHARED_HALO_H
#include "shared/types.h"
SUNDOG_SHARED_BEGIN

// How crystals lie in the air: their names in scene files. PLATE: its axis about upright;
// COLUMN: about level; PARRY: a column with two level side faces; RANDOM: any way.
#define HALO_SHAPES(SHAPE)   \
  SHAPE(HALO_PLATE, plate)   \
  SHAPE(HALO_COLUMN, column) \
  SHAPE(HALO_PARRY, parry)   \
  SHAPE(HALO_RANDOM, random)
#define HALO_PLATE 0
#define HALO_COLUMN 1
#define HALO_PARRY 2
#define HALO_RANDOM 3

// What a weight of 1 adds to a cell, and to a tally.
#define HALO_UNITS 128.0f
#define HALO_TALLY_UNITS 1048576.0f

// Rays that a work-item follows in each lane, one after another.
#define HALO_RAYS_A_LANE 64u

// Times that light meets a crystal's surface from inside, at most, and the weight below which it is given up.
#define HALO_BOUNCES 24u
#define HALO_LEAST 0.002f

// The tallies, two words each (low, high): all light that met a crystal; what went through as if none were
// there; what left in other directions; what was given up inside.
#define HALO_SENT 0u
#define HALO_PASSED 1u
#define HALO_TURNED 2u
#define HALO_KEPT 3u
#define HALO_TALLIES 4u

// 64 bytes. The rays first .. first + count - 1 of one kind of crystal in one band of wavelengths. A
// crystal's side faces lie at the distance 1 from its axis. Up is z; the sun is in the plane of x and z.
typedef struct HaloLaunch {
  u32 shape, first, count, seed;
  float half_height, weight;    // of the crystal; 1 / the greatest area that it can show to the sun
  float tilt, roll;             // standard deviations in turns
  float index_low, index_high;  // of refraction, at the ends of the band
  float sun_x, sun_z;           // towards the sun's middle, unit
  float sun_radius;             // the tangent of half its size
  u32 side;                     // cells a side of the map
  u32 pad0, pad1;
} HaloLaunch;
SUNDOG_SHARED_SIZE(HaloLaunch, 64)

SUNDOG_SHARED_END
#endif
