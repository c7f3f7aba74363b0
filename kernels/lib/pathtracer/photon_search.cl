// Photons about the surfaces of paths, within a radius: of each lane one after the other.
#pragma once
#include "lib/core/sampler_lanes.cl"
#include "lib/pathtracer/photon_cells.cl"
#include "lib/shade/bsdf.cl"

#if HAS_CAUSTICS
#define PHOTONS_A_CELL 96u  // looked at; of more, every second, third...
#define PHOTON_FLAT 0.25f   // how far from the surface photons count, of the radius; fields are rough: 1
#define PHOTON_CELLS 8u     // that a ball meets

// A lane's way through the photons about its surface.
typedef struct PhotonSearch {
  float3 p, n;  // of the surface as it stood when the shutter opened, where photons lie
  float flat;   // how far from the surface photons count
  __global const PhotonMap* map;
  HAVING(WIDE_VECTORS, int3 low;)  // lowest_cube(); GPUs have no registers for it
  u32 slice;                       // of time
  int deepest;                     // a photon was sent on at most so often
  u32 turn;                        // by which some of many photons are chosen
  u32 cell;                        // the next of PHOTON_CELLS
  u32 at, end, stride;
} PhotonSearch;

static inline __global const PhotonMap* map_of_sample(const Scene* scene, u32 sample) {
  return scene->photon_maps + (photon_map_of(sample) - scene->photon_maps[0].number);
}

// The photons of the map that the sample looks at.
static inline PhotonSearch begin_search(const Scene* scene, const LaneSamples* at, u32 depth, float time,
                                        const SurfaceInteractions* s, u32 i) {
  PhotonSearch search;
  const u32 sample = (u32)MASK_LANE(at->sample, i);
  const u32 instance = (u32)MASK_LANE(s->instance, i);
  search.p = still_point(scene, instance, get3(&s->p, i), time);
  search.n = still_vector(scene, instance, get3(&s->ng, i), time);
#if HAS_TURNS
  search.n *= rsqrt(dot(search.n, search.n));
#endif
  search.map = map_of_sample(scene, sample);
  const bool on_field = HAS_SDF && instance >= scene->info->instance_count;
  search.flat = search.map->radius * (on_field ? 1.0f : PHOTON_FLAT);
  HAVING(WIDE_VECTORS, search.low = photon_cube(search.p - search.map->radius, search.map->inverse_edge);)
  search.slice = photon_slice(time);
  search.deepest = (int)scene->info->max_depth - (int)depth;
  search.turn = hash_pixel((u32)MASK_LANE(at->x, i), (u32)MASK_LANE(at->y, i), sample * 64u + depth);
  search.cell = search.at = search.end = 0u;
  search.stride = 1u;
  return search;
}

// The cube of the lowest corner.
static inline int3 lowest_cube(const PhotonSearch* search) {
  return EITHER(WIDE_VECTORS, search->low,
                photon_cube(search->p - search->map->radius, search->map->inverse_edge));
}

// Goes to the next cube. False: there is none.
static inline bool enter_next_cube(const Scene* scene, PhotonSearch* search) {
  if (search->cell == PHOTON_CELLS) return false;
  const u32 k = search->cell++;
  const int3 cube = lowest_cube(search) + (int3)((int)(k & 1u), (int)(k >> 1 & 1u), (int)(k >> 2));
  __global const u32* begins = scene->photon_cells + search->map->first_cell;
  const u32 cell = photon_cell(cube, search->slice) & search->map->cell_mask, first = begins[cell];
  search->end = begins[cell + 1u];
  search->stride = (search->end - first + PHOTONS_A_CELL - 1u) / PHOTONS_A_CELL;
  search->at = first + (search->stride > 1u ? search->turn % search->stride : 0u);
  return true;
}

// The next photon that counts. False: there is none.
static inline bool find_photon(const Scene* scene, PhotonSearch* search, float3* wi, float3* flux) {
  const float radius = search->map->radius;
  for (;;) {
    while (search->at < search->end) {
      const u32 at = search->at;
      search->at += max(search->stride, 1u);
      const float4 place = scene->photons[2u * at];
      const float3 to = place.xyz - search->p;
      if (dot(to, to) > radius * radius || fabs(dot(to, search->n)) > search->flat) continue;
      // Other cubes and slices share the cell.
      const u32 k = search->cell - 1u;
      const int3 cube = photon_cube(place.xyz, search->map->inverse_edge) - lowest_cube(search);
      if (cube.x != (int)(k & 1u) || cube.y != (int)(k >> 1 & 1u) || cube.z != (int)(k >> 2)) continue;
      if (PHOTON_SLICES > 1u && count_of(place.w) != search->slice) continue;
      const float4 light = scene->photons[2u * at + 1u];
      if ((int)count_of(light.w) > search->deepest) continue;
      *wi = unpack_direction((float2)(without_count(place.w), without_count(light.w)));
      *flux = light.xyz * (float)(search->stride * PHOTON_SLICES);
      return true;
    }
    if (!enter_next_cube(scene, search)) return false;
  }
}

typedef struct PhotonSearches {
  PhotonSearch of[BATCH];
  REAL area;  // of each surface that photons are found on
} PhotonSearches;

static inline PhotonSearches search_photons(const Scene* scene, const LaneSamples* at, MASK depth,
                                            const SceneRays* rays, const SurfaceInteractions* s, MASK lanes) {
  PhotonSearches searches CLEARED_ON_GPUS;
  const REAL time = time_of_rays(rays);
  searches.area = (REAL)(1.0f);
  EACH_LANE(i, lanes) {
    searches.of[i] = begin_search(scene, at, (u32)MASK_LANE(depth, i), REAL_LANE(time, i), s, i);
    const REAL size = moved_size(scene, (u32)MASK_LANE(s->instance, i), time);
    const float radius = searches.of[i].map->radius * REAL_LANE(size, i);
    REAL_LANE(searches.area, i) = M_PI_F * radius * radius;
  }
  return searches;
}

// Returns the lanes that have found another.
static inline MASK next_photon(const Scene* scene, PhotonSearches* searches, MASK lanes, REAL3* wi,
                               REAL3* flux) {
  MASK found = NO_LANES;
  EACH_LANE(i, lanes) {
    float3 from = (float3)(0.0f), light = from;
    if (!find_photon(scene, searches->of + i, &from, &light)) continue;
    set3(wi, i, from);
    set3(flux, i, light);
    MASK_LANE(found, i) = -1;
  }
  return found;
}

static inline MASK photon_slices_of(const SceneRays* rays) {
  const REAL time = time_of_rays(rays);
  MASK slices = NO_LANES;
  for (u32 i = 0; i < BATCH; ++i) MASK_LANE(slices, i) = (int)photon_slice(REAL_LANE(time, i));
  return slices;
}
#endif
