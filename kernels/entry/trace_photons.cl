// One stage: photons from the lights to where they land, before the samples that look for them.
#define HAS_LANDINGS 1
#include "lib/core/counters.cl"
#include "lib/pathtracer/steps.cl"

static inline LaneSamples sample_of_photon(const Scene* scene, const PhotonLaunch* launch, MASK place) {
  const MASK number = (int)launch->first + place;
  const LaneSamples at = {(MASK)((int)(launch->map + 1u)), ~(number / (int)SOBOL_SAMPLES),
                          number % (int)SOBOL_SAMPLES, scene->info->seed};
  return at;
}

#if HAS_SCATTERING
static inline void keep_beam(__global float4* landed, MASK beam, REAL3 o, REAL length, REAL3 d,
                             MASK slice_and_sent, REAL3 flux, MASK lanes) {
  EACH_LANE(i, lanes) {
    __global float4* rows = landed + MASK_LANE(beam, i);
    rows[0] = (float4)(get3(&o, i), REAL_LANE(length, i));
    rows[1] = (float4)(get3(&d, i), (float)MASK_LANE(slice_and_sent, i));
    rows[2] = (float4)(get3(&flux, i), 1.0f);
  }
}
#endif

#include "plain/pathtracer/photon.cl"

// Photon `first` and those after it, one a lane.
NEVER_INLINE void trace_item(const Scene* scene, __global const u32* restrict light_media,
                             const PhotonLaunch* launch, u32 first, __global float4* restrict landed,
                             __global u32* restrict cells) {
  u32 counts[COUNTERS];
  for (u32 i = 0; i < COUNTERS; ++i) counts[i] = 0;
  MASK lanes = NO_LANES, places = NO_LANES;
  for (u32 i = 0; i < BATCH; ++i) {
    MASK_LANE(places, i) = (int)(first - launch->first + i);
    if (first + i < launch->last) MASK_LANE(lanes, i) = -1;
  }
  EACH_LANE(i, lanes) cells[MASK_LANE(places, i)] = NO_PHOTON;
#if HAS_SCATTERING
  const MASK beams = row_of_beam(launch, places, lanes);
  EACH_LANE(i, lanes) landed[MASK_LANE(beams, i) + 2] = (float4)(0.0f);  // no light
#endif
  const LaneSamples at = sample_of_photon(scene, launch, places);
  PhotonStarts starts;
  const MASK started = lanes & start_photon(scene, launch->targets, launch->count, &at, &starts, lanes);
#if HAS_TOUCHING  // whose faces take enough of the stack
  Photons kept;
  SceneRays way;
  Photons* const photons = &kept;
  SceneRays* const rays = &way;
#else
  KEEP_IN_MEMORY(Photons, photons);
  KEEP_IN_MEMORY(SceneRays, rays);
#endif
  *photons = begun_photon(scene, places, &at, &starts, started);
  const CameraRays begun = endless_ray(scene->info, starts.o, starts.d, starts.time, started);
  const MediaStack outside = {0, 0};
  *rays = scene_rays(&begun, outside);
  EACH_LANE(i, started) set_media(rays, i, read_media(light_media + 2 * MASK_LANE(starts.light, i)));
  for (lanes = started; any_lane(lanes);) {
    Landings landings CLEARED_ON_GPUS;
    start_marching(counts);
    const MASK going = lanes & step_photon(scene, launch, photons, rays, &landings, landed, counts, lanes);
    EACH_LANE(i, lanes & landings.is) {
      // From memory: made from `first`, the addresses would stay in registers around the loop.
      const int to = MASK_LANE(photons->place, i);
      const float3 flux = get3(&landings.flux, i);
      const float3 p = still_point(scene, (u32)MASK_LANE(landings.instance, i), get3(&landings.p, i),
                                   REAL_LANE(starts.time, i));
      const float2 wi = pack_direction(get3(&landings.wi, i));
      const u32 slice = photon_slice(REAL_LANE(starts.time, i));
      landed[2 * to] = (float4)(p, with_count(wi.x, slice));
      landed[2 * to + 1] = (float4)(flux, with_count(wi.y, (u32)MASK_LANE(landings.sent_on, i)));
      const float3 zero = (p + flux) * 0.0f;  // NaN where one is not finite
      if (zero.x + zero.y + zero.z == 0.0f)
        cells[to] = photon_cell(photon_cube(p, launch->inverse_edge), slice) & (NO_PHOTON >> 1);
    }
    lanes = going;
  }
#if HAS_SCATTERING
  const MASK ends = row_of_beam(launch, photons->place, started);
  EACH_LANE(i, started) {
    __global float4* last = landed + MASK_LANE(ends, i) + 2;
    const float light = REAL_LANE(photons->beam.scattered, i);
    // So far w says whether there is a beam.
    if (last->w > 0.0f) *last = (float4)(last->xyz * light, light);
  }
#endif
}

// Reads the scene and the media at the lights; writes what has become of the photons [launch.first,
// launch.last): to landed, two rows a photon, where it has landed, on an object as it stood when the shutter
// opened, the direction that it came from, and its flux, and after those of all photons, in media that
// scatter, three rows a photon: its beam, the third row 0 without one; to cells, its cell's number, or
// NO_PHOTON.
__kernel FOR_WAVES(2) void trace_photons(SCENE_PARAMETERS, __global const u32* restrict light_media,
                                         __global float4* restrict landed, __global u32* restrict cells,
                                         const PhotonLaunch launch) {
  const Scene scene = SCENE_OF_PARAMETERS;
  const u32 first = launch.first + (u32)get_global_id(0) * BATCH;
  if (first < launch.last) trace_item(&scene, light_media, &launch, first, landed, cells);
}
