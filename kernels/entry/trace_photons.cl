// One stage: photons from the lights to where they land, before the samples that look for them.
#define HAS_LANDINGS 1
#include "lib/core/counters.cl"
#include "lib/pathtracer/steps.cl"
#include "plain/pathtracer/photon.cl"

// Photon `first` and those after it, one a lane.
NEVER_INLINE void trace_item(const Scene* scene, __global const u32* restrict light_media,
                             const PhotonLaunch* launch, u32 first, __global float4* restrict landed,
                             __global u32* restrict cells) {
  u32 counts[COUNTERS];
  for (u32 i = 0; i < COUNTERS; ++i) counts[i] = 0;
  LaneSamples at;
  at.seed = scene->info->seed;
  MASK lanes = NO_LANES;
  for (u32 i = 0; i < BATCH; ++i) {
    const u32 number = first + i;
    MASK_LANE(at.x, i) = (int)(launch->map + 1u);
    MASK_LANE(at.y, i) = (int)(~(number / SOBOL_SAMPLES));
    MASK_LANE(at.sample, i) = (int)(number % SOBOL_SAMPLES);
    if (number < launch->last) MASK_LANE(lanes, i) = -1;
  }
  EACH_LANE(i, lanes) cells[first - launch->first + i] = NO_PHOTON;
#if HAS_SCATTERING
  __global float4* beams = landed + 2u * (launch->last - launch->first) + 3u * (first - launch->first);
  EACH_LANE(i, lanes) beams[3u * i + 2u] = (float4)(0.0f);  // no light
#endif
  PhotonStarts starts;
  const MASK started = lanes & start_photon(scene, launch->targets, launch->count, &at, &starts, lanes);
  // Touching faces take enough of the stack.
  EITHER(HAS_TOUCHING, Photons kept; Photons* const photons = &kept;, KEEP_IN_MEMORY(Photons, photons);)
  *photons = begun_photon(scene, &at, &starts, started);
  const CameraRays begun = endless_ray(scene->info, starts.o, starts.d, starts.time, started);
  const MediaStack outside = {0, 0};
  SceneRays rays = scene_rays(&begun, outside);
  EACH_LANE(i, started) set_media(&rays, i, read_media(light_media + 2 * MASK_LANE(starts.light, i)));
  for (lanes = started; any_lane(lanes);) {
    Landings landings CLEARED_ON_GPUS;
    start_marching(counts);
    const MASK going = lanes & step_photon(scene, photons, &rays, &landings, counts, lanes);
    EACH_LANE(i, lanes & landings.is) {
      const u32 to = first - launch->first + i;
      const float3 flux = get3(&landings.flux, i);
      const float3 p = still_point(scene, (u32)MASK_LANE(landings.instance, i), get3(&landings.p, i),
                                   REAL_LANE(starts.time, i));
      const float2 wi = pack_direction(get3(&landings.wi, i));
      const u32 slice = photon_slice(REAL_LANE(starts.time, i));
      landed[2u * to] = (float4)(p, with_count(wi.x, slice));
      landed[2u * to + 1u] = (float4)(flux, with_count(wi.y, (u32)MASK_LANE(landings.sent_on, i)));
      const float3 zero = (p + flux) * 0.0f;  // NaN where one is not finite
      if (zero.x + zero.y + zero.z == 0.0f)
        cells[to] = photon_cell(photon_cube(p, launch->inverse_edge), slice) & (NO_PHOTON >> 1);
    }
    lanes = going;
  }
#if HAS_SCATTERING
  EACH_LANE(i, started & MASK_OF(photons->beam.length > 0.0f)) {
    const float light = REAL_LANE(photons->beam.scattered, i);
    const u32 slice = photon_slice(REAL_LANE(starts.time, i));
    const u32 slice_and_sent = slice + PHOTON_SLICES * (u32)MASK_LANE(photons->beam.sent_on, i);
    beams[3u * i] = (float4)(get3(&photons->beam.o, i), REAL_LANE(photons->beam.length, i));
    beams[3u * i + 1u] = (float4)(get3(&photons->beam.d, i), (float)slice_and_sent);
    beams[3u * i + 2u] = (float4)(get3(&photons->beam.flux, i) * light, light);
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
