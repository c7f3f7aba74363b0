// Photons about the surfaces of paths, within a radius: of each lane one after the other.
#pragma once
#include "lib/core/sampler_lanes.cl"
#include "lib/pathtracer/photon_cells.cl"
#include "lib/shade/bsdf.cl"

#if HAS_CAUSTICS
#define PHOTONS_A_ROW 192u  // looked at; of more, every second, third...
#define PHOTON_FLAT 0.25f   // how far from the surface photons count, of the radius; fields are rough: 1
#define PHOTON_ROWS 4u      // of cubes that a disk meets

// A lane's way through the photons about its surface.
typedef struct PhotonSearch {
  __global const PhotonMap* map;
  u32 row;              // the next of PHOTON_ROWS
  u32 at, end, stride;  // the row's photons to look at
  u32 near;             // of the LANES photons before these, a bit for each that counts
} PhotonSearch;

typedef struct PhotonSearches {
  PhotonSearch of[BATCH];
  REAL3 p, n;     // of surfaces as they stood when the shutter opened, where photons lie
  REAL flat;      // how far from the surface photons count
#if WIDE_VECTORS  // GPUs have no registers for the disk's bounds: they take the ball's, which meets all rows
  MASK x, y, z;   // the cube of the disk's lowest corner
  MASK across;    // a bit for each axis along which the disk meets two cubes
#endif
  MASK slice;    // of time
  MASK deepest;  // a photon was sent on at most so often
  UINTS turn;    // by which some of many photons are chosen
  REAL area;     // of each surface that photons are found on
} PhotonSearches;

static inline __global const PhotonMap* map_of_sample(const Scene* scene, u32 sample) {
  return scene->photon_maps + (photon_map_of(sample) - scene->photon_maps[0].number);
}

static inline MASK photon_slices_of(const SceneRays* rays) {
  const REAL time = time_of_rays(rays);
  MASK slices = NO_LANES;
  for (u32 i = 0; i < BATCH; ++i) MASK_LANE(slices, i) = (int)photon_slice(REAL_LANE(time, i));
  return slices;
}

#if WIDE_VECTORS
// The cubes that a disk meets along an axis: the lowest, and whether there is another.
static inline MASK cubes_along(REAL p, REAL n, REAL flat, REAL radius, REAL scale, MASK* low) {
  const REAL reach = fmin(radius, radius * real_sqrt(real_max((REAL)(0.0f), 1.0f - n * n)) + flat * fabs(n));
  *low = IN_LANES(convert_int, _sat_rtn)((p - reach) * scale);
  return MASK_OF(IN_LANES(convert_int, _sat_rtn)((p + reach) * scale) > *low);
}
#endif

static inline PhotonSearches search_photons(const Scene* scene, const LaneSamples* at, MASK depth,
                                            const SceneRays* rays, const SurfaceInteractions* s, MASK lanes) {
  PhotonSearches searches CLEARED_ON_GPUS;
  REAL radius = (REAL)(1.0f), size = radius, flat = radius, scale = radius;
  searches.p = s->p;
  searches.n = s->ng;
  EACH_LANE(i, lanes) {
    const u32 instance = (u32)MASK_LANE(s->instance, i);
    const bool on_field = HAS_SDF && instance >= scene->info->instance_count;
#if HAS_OBJECT_MOTION
    const REAL time = time_of_rays(rays), moved = moved_size(scene, instance, time);
    set3(&searches.p, i, still_point(scene, instance, get3(&s->p, i), REAL_LANE(time, i)));
    set3(&searches.n, i, still_vector(scene, instance, get3(&s->ng, i), REAL_LANE(time, i)));
    REAL_LANE(size, i) = REAL_LANE(moved, i);
#endif
    PhotonSearch* search = searches.of + i;
    search->map = map_of_sample(scene, (u32)MASK_LANE(at->sample, i));
    search->row = search->at = search->end = search->near = 0u;
    search->stride = 1u;
    REAL_LANE(radius, i) = search->map->radius;
    REAL_LANE(scale, i) = search->map->inverse_edge;
    REAL_LANE(flat, i) = search->map->radius * (on_field ? 1.0f : PHOTON_FLAT);
  }
#if HAS_TURNS
  searches.n = renormalized3(searches.n);
#endif
  searches.flat = flat;
  searches.area = M_PI_F * (radius * size) * (radius * size);
#if WIDE_VECTORS
  const REAL3 p = searches.p, n = searches.n;
  searches.across = (cubes_along(p.x, n.x, flat, radius, scale, &searches.x) & 1) |
                    (cubes_along(p.y, n.y, flat, radius, scale, &searches.y) & 2) |
                    (cubes_along(p.z, n.z, flat, radius, scale, &searches.z) & 4);
#endif
  searches.slice = photon_slices_of(rays);
  searches.deepest = (MASK)((int)scene->info->max_depth) - depth;
  const UINTS sample = AS_UINTS(at->sample * 64 + depth);
  searches.turn = hash_lanes(AS_UINTS(at->x) + hash_lanes(AS_UINTS(at->y) + hash_lanes(sample)));
  return searches;
}

// The lowest cube of a row.
static inline int3 cube_of_row(const PhotonSearches* searches, u32 i, u32 row) {
#if WIDE_VECTORS
  const int3 low = (int3)(MASK_LANE(searches->x, i), MASK_LANE(searches->y, i), MASK_LANE(searches->z, i));
#else
  __global const PhotonMap* map = searches->of[i].map;
  const int3 low = photon_cube(get3(&searches->p, i) - map->radius, map->inverse_edge);
#endif
  return low + (int3)(0, (int)(row & 1u), (int)(row >> 1));
}

// Goes to the next row of cubes. False: there is none.
static inline bool enter_next_row(const Scene* scene, PhotonSearches* searches, u32 i) {
  PhotonSearch* search = searches->of + i;
  const u32 across = EITHER(WIDE_VECTORS, (u32)MASK_LANE(searches->across, i), 7u);
  for (u32 row = search->row; row < PHOTON_ROWS; ++row) {
    if ((row & ~(across >> 1)) != 0u) continue;
    search->row = row + 1u;
    __global const u32* begins = scene->photon_cells + search->map->first_cell;
    const u32 slice = (u32)MASK_LANE(searches->slice, i), of_map = search->map->cell_mask;
    const u32 cell = photon_cell(cube_of_row(searches, i, row), slice) & of_map;
    search->at = begins[cell];
    search->end = begins[cell + 1u + (across & 1u)];
    search->stride = (search->end - search->at + PHOTONS_A_ROW - 1u) / PHOTONS_A_ROW;
    if (search->stride > 1u) search->at += (u32)MASK_LANE(searches->turn, i) % search->stride;
    if (search->at < search->end) return true;
  }
  search->row = PHOTON_ROWS;
  return false;
}

// Looks at the row's next LANES photons at once.
static inline void look_at_photons(const Scene* scene, PhotonSearches* searches, u32 i) {
  PhotonSearch* search = searches->of + i;
  __global const float4* rows = scene->photons + search->at;
  u32 left = search->end - search->at;
  REAL3 p;
  REAL w;
  if (search->stride == 1u) {
    load_rows(rows, &p, &w);
  } else {
    left = (left + search->stride - 1u) / search->stride;
    for (u32 k = 0; k < min(left, (u32)LANES); ++k) {
      set3(&p, k, rows[k * search->stride].xyz);
      REAL_LANE(w, k) = rows[k * search->stride].w;
    }
  }
  const float radius = search->map->radius, scale = search->map->inverse_edge;
  const REAL3 to = subtract3(p, all3(get3(&searches->p, i)));
  MASK near = MASK_OF(dot3(to, to) <= radius * radius) &
              MASK_OF(fabs(dot3(to, all3(get3(&searches->n, i)))) <= REAL_LANE(searches->flat, i)) &
              MASK_OF(LANE_NUMBERS < (MASK)((int)left));
  // Other rows and slices share the cells.
  const int3 cube = cube_of_row(searches, i, search->row - 1u);
  near &= MASK_OF(floor(p.y * scale) == (float)cube.y) & MASK_OF(floor(p.z * scale) == (float)cube.z);
  if (PHOTON_SLICES > 1u) near &= MASK_OF(counts_of(w) == (float)MASK_LANE(searches->slice, i));
  search->near = lane_bits(near);
  search->at += LANES * search->stride;
}

// The row in the table of the next photon that counts. False: there is none.
static inline bool find_photon(const Scene* scene, PhotonSearches* searches, u32 i, u32* row) {
  PhotonSearch* search = searches->of + i;
  while (!search->near) {
    if (search->at >= search->end && !enter_next_row(scene, searches, i)) return false;
    look_at_photons(scene, searches, i);
  }
  *row = search->at - (LANES - lowest_bit(search->near)) * search->stride;
  search->near &= search->near - 1u;
  return true;
}

// Returns the lanes that have found another.
static inline MASK next_photon(const Scene* scene, PhotonSearches* searches, MASK lanes, REAL3* wi,
                               REAL3* flux) {
  MASK found = NO_LANES;
  REAL u = (REAL)(0.0f), v = u;
  EACH_LANE(i, lanes) {
    u32 row;
    if (!find_photon(scene, searches, i, &row)) continue;
    const PhotonSearch* search = searches->of + i;
    const float4 light = scene->photons[row + search->map->photons];
    set3(flux, i, light.xyz * (float)(search->stride * PHOTON_SLICES));
    REAL_LANE(u, i) = scene->photons[row].w;
    REAL_LANE(v, i) = light.w;
    MASK_LANE(found, i) = -1;
  }
  *wi = unpack_directions(without_counts(u), without_counts(v));
  const MASK too_deep = MASK_OF(counts_of(v) > TO_REAL(searches->deepest));
  *flux = select3(*flux, all3((float3)(0.0f)), too_deep);
  return found;
}
#endif
