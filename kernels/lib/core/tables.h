// The scene as kernels see it: SceneInfo and the tables of shared/scene_tables.h. A kernel takes them as
// parameters, since OpenCL C 1.2 allows no pointers in a struct argument, and collects them in a Scene for
// its callees:
//   __kernel void f(SCENE_PARAMETERS, ...) { const Scene scene = SCENE_OF_PARAMETERS; ... }
#pragma once
#include "shared/scene_tables.h"

#define SCENE_MEMBER(type, host_type, name, label) __global const type* restrict name;
typedef struct Scene {
  __global const SceneInfo* restrict info;
  SCENE_TABLES(SCENE_MEMBER)
} Scene;

#define SCENE_PARAMETER(type, host_type, name, label) , __global const type* restrict name
#define SCENE_PARAMETERS __global const SceneInfo* restrict info SCENE_TABLES(SCENE_PARAMETER)

#define SCENE_VALUE(type, host_type, name, label) , name
#define SCENE_OF_PARAMETERS {info SCENE_TABLES(SCENE_VALUE)}

// Prefetches the start of a row that is read later.
#if defined(__AVX2__) && !defined(SUNDOG_PORTABLE)
#define FETCH_ROW(row) __builtin_prefetch((const void*)(ulong)(row))
#else
#define FETCH_ROW(row)
#endif
