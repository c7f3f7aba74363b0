// The scene's tables as kernel parameters. OpenCL C 1.2 has no portable struct of pointers, so the lists are
// macros: TRACE_* is what finding a hit needs, SHADE_* what shading it needs besides. A buffer has one name
// everywhere. `nodes` are BvhNodes (nodes.cl).
#ifndef SUNDOG_LIB_TABLES_H
#define SUNDOG_LIB_TABLES_H
#include "shared/bvh.h"
#include "shared/scene.h"
#include "shared/sdf.h"

#define TRACE_PARAMETERS                                                            \
  __global const SceneInfo *restrict info, __global const u32 *restrict nodes, \
      __global const TriangleBlock *restrict blocks, __global const Instance *restrict instances
#define TRACE_ARGUMENTS info, nodes, blocks, instances

#define SHADE_PARAMETERS                                                                        \
  __global const TriangleShading *restrict triangles, __global const Vertex *restrict vertices, \
      __global const Material *restrict materials, __global const Medium *restrict media,       \
      __global const Light *restrict lights, __global const SdfField *restrict sdf_fields,      \
      __global const float *restrict sdf_parameters
#define SHADE_ARGUMENTS triangles, vertices, materials, media, lights, sdf_fields, sdf_parameters

#endif
