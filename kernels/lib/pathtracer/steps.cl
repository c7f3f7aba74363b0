// What plain text of the path tracer uses (plain/pathtracer/interface.h).
#ifndef SUNDOG_LIB_PATH_STEPS_CL
#define SUNDOG_LIB_PATH_STEPS_CL
#include "lib/light/shadow.cl"
#include "lib/light/shadow_rays.cl"
#include "lib/path/ray_counts.cl"
#include "lib/pathtracer/photon_search.cl"
#include "lib/pathtracer/sampled_spectrum.cl"
#include "lib/shade/bsdf_sample.cl"
#endif
