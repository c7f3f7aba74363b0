// Halos: launch parameters and counters of the kernel that traces light through ice crystals.
#pragma once
#include "shared/types.h"
SUNDOG_SHARED_BEGIN

// Orientations of crystals, with their names in scene files. PLATE: axis near vertical; COLUMN: near
// horizontal; PARRY: a column with two horizontal side faces; RANDOM: any.
#define HALO_SHAPES(SHAPE)   \
  SHAPE(HALO_PLATE, plate)   \
  SHAPE(HALO_COLUMN, column) \
  SHAPE(HALO_PARRY, parry)   \
  SHAPE(HALO_RANDOM, random)
#define HALO_PLATE 0
#define HALO_COLUMN 1
#define HALO_PARRY 2
#define HALO_RANDOM 3

// Amount that a weight of 1 adds to a cell, and to a tally.
#define HALO_UNITS 128.0f
#define HALO_TALLY_UNITS 1048576.0f

// Rays that a work-item traces per lane, one after another.
#define HALO_RAYS_A_LANE 64u

// Maximum number of internal hits, and the weight below which light is dropped.
#define HALO_BOUNCES 24u
#define HALO_LEAST 0.002f

// The tallies, two words each (low, high): all light that hit a crystal; light that passed unchanged; light
// that left in other directions; light dropped inside.
#define HALO_SENT 0u
#define HALO_PASSED 1u
#define HALO_TURNED 2u
#define HALO_KEPT 3u
#define HALO_TALLIES 4u

// 64 bytes. The rays first .. first + count - 1 of one kind of crystal in one wavelength band. A crystal's
// side faces are at distance 1 from its axis. z is up; the sun is in the xz plane.
typedef struct HaloLaunch {
  u32 shape, first, count, seed;
  float half_height, weight;    // of the crystal; 1 / the largest area that it can show to the sun
  float tilt, roll;             // standard deviations in turns
  float index_low, index_high;  // refractive indices at the ends of the band
  float sun_x, sun_z;           // towards the sun's centre, unit
  float sun_radius;             // tangent of half its diameter
  u32 side;                     // cells per side of the map
  u32 pad0, pad1;
} HaloLaunch;
SUNDOG_SHARED_SIZE(HaloLaunch, 64)

SUNDOG_SHARED_END
