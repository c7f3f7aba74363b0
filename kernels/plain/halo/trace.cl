// Traces sunlight through crystals of one kind to the map of the sky.
#include "plain/halo/exits.cl"
#include "plain/halo/sky_map.cl"

// Weights by destination (HALO_SENT, ...).
typedef struct HaloSum {
  int weights[HALO_TALLIES];
} HaloSum;

void add_to_cells(UNIFORM __global u32* map, int cell, int units, HERE);

static inline int tally_of(float weight) { return (int)(weight * HALO_TALLY_UNITS + 0.5f); }

// Counts light that leaves where observers see it: integer units, rounded randomly, so that the mean is exact
// and little light costs little. Light leaving in its original direction (through parallel faces) is no halo:
// it appears at the sun.
static inline void count_light(UNIFORM const HaloLaunch* launch, UNIFORM __global u32* map,
                               const LeavingLight* light, CrystalRay* ray, HaloSum* sum) {
  const int units = (int)(light->weight * HALO_UNITS + halo_random(&ray->random));
  const bool straight = halo_dot(light->d, ray->sunlight) > 0.999995f;
  const int weight = tally_of(light->weight);
  sum->weights[HALO_PASSED] += straight ? weight : 0;
  sum->weights[HALO_TURNED] += straight ? 0 : weight;
  if (!straight && units > 0) {
    const float3 d = light->d, x = ray->x, y = ray->y, z = ray->z;
    const float3 seen = (float3)(-(d.x * x.x + d.y * y.x + d.z * z.x), -(d.x * x.y + d.y * y.y + d.z * z.y),
                                 -(d.x * x.z + d.y * y.z + d.z * z.z));
    add_to_cells(map, equal_area_cell(seen, launch->side), units);
  }
}

// Follows the ray `index` through a crystal.
static inline void trace_crystal(UNIFORM const HaloLaunch* launch, UNIFORM __global u32* map, u32 index,
                                 HaloSum* sum) {
  CrystalRay ray;
  LeavingLight light = enter_crystal(launch, index, &ray);
  sum->weights[HALO_SENT] += tally_of(ray.throughput + light.weight);
  count_light(launch, map, &light, &ray, sum);
  float kept = ray.throughput;
  for (u32 bounce = 0; bounce < HALO_BOUNCES; ++bounce) {
    light = reflect_inside(launch, &ray);
    count_light(launch, map, &light, &ray, sum);
    kept = ray.throughput;
    if (kept < HALO_LEAST) break;
  }
  sum->weights[HALO_KEPT] += tally_of(kept);
}

// HALO_RAYS_A_LANE rays of the launch: `first`, `first` + `step`, ... Adds to `sum`.
ENTRY static void trace_crystals(UNIFORM const HaloLaunch* launch, UNIFORM __global u32* map, u32 first,
                                 UNIFORM u32 step, HaloSum* sum) {
  u32 index = first;
  for (u32 round = 0; round < HALO_RAYS_A_LANE; ++round) {
    if (index >= launch->count) break;
    trace_crystal(launch, map, launch->first + index, sum);
    index += step;
  }
}
