// Photon maps of light that lamps send through glass and off mirrors (Jensen 1996, "Global Illumination using
// Photon Maps"; Hachisuka and Jensen 2009, "Stochastic Progressive Photon Mapping"). A pixel sample uses one
// map, successive samples use many: each map has its own photons and a smaller radius than those before, and
// is independent of them (Knaus and Zwicker 2011, "Progressive Photon Mapping: A Probabilistic Approach").
#pragma once
#include "shared/types.h"
SUNDOG_SHARED_BEGIN

#define PHOTON_MAP_SAMPLES 4u  // samples of each pixel that use one map, among the first PHOTON_SAMPLES
#define PHOTON_SAMPLES 1024u   // from here on, samples per map double whenever samples double

// The number of the map that a pixel's sample uses.
static inline u32 photon_map_of(u32 sample) {
  u32 number = 0, first = 0, share = PHOTON_MAP_SAMPLES, end = PHOTON_SAMPLES;
  while (sample >= end) {
    number += (end - first) / share;
    first = end;
    end *= 2u;
    share *= 2u;
  }
  return number + (sample - first) / share;
}

// 32 bytes: a target of photons: a ball around reflecting or refracting objects. Row 0 of the table is a ball
// around everything.
typedef struct PhotonTarget {
  float4 ball;   // w = radius
  float weight;  // fraction of photons sent to it
  float before;  // sum of the weights of earlier rows
  u32 pad0, pad1;
} PhotonTarget;
SUNDOG_SHARED_SIZE(PhotonTarget, 32)

// 32 bytes: one map. Its photons are hashed by cubes with edges of two radii; those of a cube are contiguous
// in the table `photons`, in order of their numbers, perhaps mixed with those of colliding cubes: first the
// places of all, then their light. photon_cells holds the start of each cell's photons, and the end. Cubes in
// a row along x have cells that follow each other; for rows that go around, the first cell's photons stand a
// second time after those of the last. After the light the table has the map's beams, ways of photons through
// media that scatter, in groups, as many for each of the samples that use the map. The beams of a group lie
// in a cone: its first two rows are a point of its axis, and the radius there; the axis's direction, and how
// much the radius grows on a unit of it. Each beam has three: where it begins and its length (0: none); its
// direction, and its slice of time + PHOTON_SLICES times how often the photon had been sent on; its flux, and
// the light that the medium scatters of it.
typedef struct PhotonMap {
  u32 number;
  u32 first_cell;      // in photon_cells
  u32 cell_mask;       // number of cells, a power of two, minus 1
  float radius;        // photons within it count
  float inverse_edge;  // 1 / a cube's edge
  u32 first_beam;      // its first row in photons
  u32 beam_groups;     // for one sample
  u32 photons;         // rows from a photon's place to its light
} PhotonMap;
SUNDOG_SHARED_SIZE(PhotonMap, 32)

#define BEAM_GROUP 16u                          // beams of a group
#define BEAM_GROUP_ROWS (2u + 3u * BEAM_GROUP)  // in photons

#define NO_PHOTON 0xffffffffu  // the cell of a photon that did not land

// 32 bytes: one launch: photons [first, last) of the map `map`, which emits `count`.
typedef struct PhotonLaunch {
  u32 map, first, last, count;
  u32 targets;  // rows of photon_targets, including row 0
  float inverse_edge;
  u32 pad0, pad1;
} PhotonLaunch;
SUNDOG_SHARED_SIZE(PhotonLaunch, 32)

SUNDOG_SHARED_END
