// Hand-written functions that the plain path tracer calls (plain/pathtracer/interface.h).
#pragma once
#include "lib/light/shadow.cl"
#include "lib/path/ray_counts.cl"
#include "lib/pathtracer/photon_search.cl"
#include "lib/pathtracer/sampled_spectrum.cl"
