// Photons: light on its way from the lamps through glass and off mirrors, and the maps that keep where it
// lands (Jensen 1996, "Global Illumination using Photon Maps"; Hachisuka and Jensen 2009, "Stochastic
// Progressive Photon Mapping"). A sample of a pixel looks at one map, samples one after another at many: each
// has photons of its own and a smaller radius than those before, and is independent of them (Knaus and
// Zwicker 2011, "Progressive Photon Mapping: A Probabilistic Approach").
#ifndef SUNDOG_SHARED_PHOTONS_H
#define SUNDOG_SHARED_PHOTONS_H
#include "shared/types.h"
SUNDOG_SHARED_BEGIN

#define PHOTON_MAP_SAMPLES 4u  // of each pixel look at one map, among the first PHOTON_SAMPLES
#define PHOTON_SAMPLES 1024u   // each time that samples double from here on, those on a map double

// The number of the map that a pixel's sample looks at.
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

// 32 bytes: a ball about things that mirror or bend light, which photons are sent to. Row 0 of the table is a
// ball about everything.
typedef struct PhotonTarget {
  float4 ball;   // w = radius
  float weight;  // the part of the photons that is sent there
  float before;  // the sum of the weights of the rows before
  u32 pad0, pad1;
} PhotonTarget;
SUNDOG_SHARED_SIZE(PhotonTarget, 32)

// 32 bytes: one map. Its photons lie in cubes of two radii along each axis; those of a cube stand together in
// the table `photons`, in the order of their numbers, and other cubes' may stand among them. photon_cells
// has where each cell's photons begin, a cell more than there are.
typedef struct PhotonMap {
  u32 number;
  u32 first_cell;      // in photon_cells
  u32 cell_mask;       // the number of cells, a power of two, less 1
  float radius;        // within which photons count
  float inverse_edge;  // 1 over a cube's edge
  u32 pad0, pad1, pad2;
} PhotonMap;
SUNDOG_SHARED_SIZE(PhotonMap, 32)

#define NO_PHOTON 0xffffffffu  // the cell of a photon that has not landed

// 32 bytes: what one launch makes: photons [first, last) of the map `map`, which sends out `count`.
typedef struct PhotonLaunch {
  u32 map, first, last, count;
  u32 targets;  // rows of photon_targets, row 0 among them
  float inverse_edge;
  u32 pad0, pad1;
} PhotonLaunch;
SUNDOG_SHARED_SIZE(PhotonLaunch, 32)

SUNDOG_SHARED_END
#endif
