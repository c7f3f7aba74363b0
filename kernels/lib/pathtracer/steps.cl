// One step of a batch of paths, a path a lane. Nothing waits: a path is its one ray and its PathStates.
#ifndef SUNDOG_LIB_PATH_STEPS_CL
#define SUNDOG_LIB_PATH_STEPS_CL
#include "lib/path/ray_counts.cl"
#include "lib/pathtracer/gather_photons.cl"
#include "lib/pathtracer/guides.cl"
#include "lib/pathtracer/leave_surfaces.cl"
#include "lib/pathtracer/met_light.cl"
#include "lib/pathtracer/next_event.cl"
#include "lib/pathtracer/scatter_media.cl"
#include "plain/pathtracer/bounce.cl"
#endif
