// Light that photons bring to the surfaces of paths: the mean of those within a radius. A surface a lane.
#ifndef SUNDOG_LIB_GATHER_PHOTONS_CL
#define SUNDOG_LIB_GATHER_PHOTONS_CL
#include "lib/light/shadow_rays.cl"
#include "lib/pathtracer/path_state.cl"
#include "lib/pathtracer/photon_cells.cl"
#include "lib/shade/wide_lobes.cl"

#if HAS_CAUSTICS
#define PHOTONS_A_CELL 96u   // looked at; of more, every second, third...
#define PHOTON_FLAT 0.25f    // how far from the surface photons count, of the radius
#define PHOTON_CELLS 8u      // that a ball meets
#define PHOTON_COSINE 0.01f  // below it photons count as if they came at it

// A lane's way through the photons about its surface.
typedef struct PhotonSearch {
  float3 p, n;
  PhotonMap map;
  int3 low;     // the cube of the lowest corner
  u32 slice;    // of time
  int deepest;  // a photon was sent on at most so often
  u32 turn;     // by which some of many photons are chosen
  u32 cell;     // the next of PHOTON_CELLS
  u32 at, end, stride;
} PhotonSearch;

// The photons of the map that the sample looks at.
static inline PhotonSearch search_photons(const Scene* scene, const PathStates* paths, REAL time,
                                          const SurfaceInteractions* s, u32 i) {
  PhotonSearch search;
  const u32 sample = (u32)MASK_LANE(paths->at.sample, i), depth = (u32)MASK_LANE(paths->depth, i);
  search.p = get3(&s->p, i);
  search.n = get3(&s->ng, i);
  search.map = scene->photon_maps[photon_map_of(sample) - scene->photon_maps[0].number];
  search.low = photon_cube(search.p - search.map.radius, search.map.inverse_edge);
  search.slice = photon_slice(REAL_LANE(time, i));
  search.deepest = (int)scene->info->max_depth - (int)depth;
  search.turn =
      hash_pixel((u32)MASK_LANE(paths->at.x, i), (u32)MASK_LANE(paths->at.y, i), sample * 64u + depth);
  search.cell = search.at = search.end = 0u;
  search.stride = 1u;
  return search;
}

// Goes to the next cube. False: there is none.
static inline bool enter_next_cube(const Scene* scene, PhotonSearch* search) {
  if (search->cell == PHOTON_CELLS) return false;
  const u32 k = search->cell++;
  const int3 cube = search->low + (int3)((int)(k & 1u), (int)(k >> 1 & 1u), (int)(k >> 2));
  __global const u32* begins = scene->photon_cells + search->map.first_cell;
  const u32 cell = photon_cell(cube, search->slice) & search->map.cell_mask, first = begins[cell];
  search->end = begins[cell + 1u];
  search->stride = (search->end - first + PHOTONS_A_CELL - 1u) / PHOTONS_A_CELL;
  search->at = first + (search->stride > 1u ? search->turn % search->stride : 0u);
  return true;
}

// The next photon that counts. False: there is none.
static inline bool next_photon(const Scene* scene, PhotonSearch* search, float3* wi, float3* flux) {
  const float radius = search->map.radius;
  for (;;) {
    while (search->at < search->end) {
      const u32 at = search->at;
      search->at += max(search->stride, 1u);
      const float4 place = scene->photons[2u * at];
      const float3 to = place.xyz - search->p;
      if (dot(to, to) > radius * radius || fabs(dot(to, search->n)) > PHOTON_FLAT * radius) continue;
      // Other cubes and slices share the cell.
      const u32 k = search->cell - 1u;
      const int3 cube = photon_cube(place.xyz, search->map.inverse_edge) - search->low;
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

// What surfaces of `lanes` make of the photons about them, over the area that they stand for.
static inline REAL3 scatter_photons(const Scene* scene, const SurfaceInteractions* s, const WideLobes* wide,
                                    REAL3 wo, REAL3 wi, REAL3 flux, MASK lanes) {
  const Lobes* lobes = &wide->lobes;
  REAL unused;
  const REAL3 value = bsdf_scatter(scene, &wide->bsdf, lobes, wo, wi, lanes, &unused);
  const REAL cosine = dot3(s->ng, wi), arriving = real_max(fabs(cosine), (REAL)(PHOTON_COSINE));
  const MASK below = MASK_OF(cosine < 0.0f);
  REAL factor = 1.0f / (M_PI_F * arriving);
  if (HAS_RELIEF) factor *= select(terminator(s, wi), (REAL)(1.0f), below);
  if (HAS_MEDIA) factor = select(factor, factor / (lobes->split.eta * lobes->split.eta), below);
  return select3(all3((float3)(0.0f)), scale3(multiply3(value, flux), factor), lanes);
}

// The light of photons that the surfaces of `lanes` send along their paths.
NEVER_INLINE SampledSpectrum gather_photons(const Scene* scene, const PathStates* paths,
                                            const SceneRays* rays, const Shading* at, const Lobes* lobes,
                                            MASK lanes) {
  const REAL3 wo = negate3(rays->d);
  REAL3 sum = all3((float3)(0.0f)), wi = wo, flux = sum;
  REAL area = (REAL)(1.0f);
  const WideLobes wide = wide_lobes(&at->bsdf, lobes);
  PhotonSearch searches[BATCH];
  for (u32 bits = lane_bits(lanes); bits; bits &= bits - 1u) {
    const u32 i = lowest_bit(bits);
    searches[i] = search_photons(scene, paths, time_of_rays(rays), &at->s, i);
    REAL_LANE(area, i) = M_PI_F * searches[i].map.radius * searches[i].map.radius;
  }
  for (MASK left = lanes; any_lane(left);) {
    for (u32 bits = lane_bits(left); bits; bits &= bits - 1u) {
      const u32 i = lowest_bit(bits);
      float3 from, light;
      if (next_photon(scene, searches + i, &from, &light)) {
        set3(&wi, i, from);
        set3(&flux, i, light);
      } else {
        MASK_LANE(left, i) = 0;
      }
    }
    if (any_lane(left)) sum = add3(sum, scatter_photons(scene, &at->s, &wide, wo, wi, flux, left));
  }
  return carried_color(paths, scale3(sum, 1.0f / area));
}
#else
static inline SampledSpectrum gather_photons(const Scene* scene, const PathStates* paths,
                                             const SceneRays* rays, const Shading* at, const Lobes* lobes,
                                             MASK lanes) {
  return spectrum_all(0.0f);
}
#endif

#endif
