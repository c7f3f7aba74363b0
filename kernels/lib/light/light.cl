// Where light comes from: the scene's lights, and what glows by itself. A point or a ray a lane.
#pragma once
#include "lib/core/tables.h"
#include "lib/light/environment.cl"
#include "lib/path/scene_ray.cl"
#include "plain/light/sky.cl"
