// Constants that specialise kernels to a device, with defaults, and derived constants of a scene's features
// (shared/features.h, shared/shapes.h; HAS_MESH, HAS_SPHERE, ...: it has that shape; HAS_BVH: rays traverse a
// BVH). The host's KernelConfig writes the -D options. Thresholds of a method stand beside the method.
#pragma once
#include "shared/shapes.h"

#pragma OPENCL FP_CONTRACT OFF
#ifdef __clang__
// Vectors wider than the processor's are harmless: functions are inlined, or called within one program.
#pragma clang diagnostic ignored "-Wpsabi"
#endif

// Without the instruction, fma() is emulated by a routine inlined at every use (rusticl took 12 times as long
// to compile); two roundings suffice here. PoCL does not define FP_FAST_FMAF, but the host's __FMA__; for
// devices other than CPUs the host defines DEVICE_HAS_FMA if the driver reports it.
#if defined(FP_FAST_FMAF) || defined(__FMA__) || defined(DEVICE_HAS_FMA)
#define HAS_FMA 1
#else
#define HAS_FMA 0
#define fma(a, b, c) ((a) * (b) + (c))
#endif

// For inner loops, where a call would save and restore every vector register. Not without optimisation:
// Oclgrind does not know the marks that inlining leaves.
#ifdef __NO_INLINE__
#define ALWAYS_INLINE static inline
#else
#define ALWAYS_INLINE static inline __attribute__((always_inline))
#endif

// For the body of a kernel: PoCL compiles the body of a kernel three times (the kernel, and two loops over
// its work-groups), but a function once, and separates the private arrays of a kernel for each work-item of a
// group, but not those of a function. Such a function must not call get_global_id(), or PoCL inlines it. Also
// for functions with several callers, whose copies would compile longer than calls take.
// On GPUs (host/device/device_rules.cpp) neither applies, and a call passes its structs, and the scene's
// pointers, through memory: everything is inlined.
#ifdef DEVICE_INLINES_ALL
#define NEVER_INLINE ALWAYS_INLINE
#define inline inline __attribute__((always_inline))
#else
#define NEVER_INLINE static __attribute__((noinline))
#endif

// Waves of a SIMD that the registers of both integrators leave room for (host/device/device_rules.cpp),
// photons' two more, on RDNA 3 and newer, where plain scenes need no spills for that.
#if defined(DEVICE_WAVES) && (defined(__GFX11__) || defined(__GFX12__))
#define FOR_WAVES(more) __attribute__((amdgpu_waves_per_eu(DEVICE_WAVES + more)))
#else
#define FOR_WAVES(more)
#endif

// Rays that a thread of Intel's GPUs takes at once, for kernels that need no spills for that with 256
// registers.
#if defined(DEVICE_SUBGROUP) && defined(cl_intel_required_subgroup_size)
#define FOR_SUBGROUP __attribute__((intel_reqd_sub_group_size(DEVICE_SUBGROUP)))
#else
#define FOR_SUBGROUP
#endif

// HAVING: a member or statements for a feature alone. EITHER: one value with it, another without. Features
// are 0 or 1, or ANY_OF() two.
#define HAVING(feature, text) HAVING_IF(feature, text)
#define HAVING_IF(feature, text) HAVING_##feature(text)
#define HAVING_0(text)
#define HAVING_1(text) text
#define EITHER(feature, with, without) EITHER_IF(feature, with, without)
#define EITHER_IF(feature, with, without) EITHER_##feature(with, without)
#define EITHER_0(with, without) without
#define EITHER_1(with, without) with
#define ANY_OF(a, b) ANY_OF_IF(a, b)
#define ANY_OF_IF(a, b) ANY_OF_##a##b
#define ANY_OF_00 0
#define ANY_OF_01 1
#define ANY_OF_10 1
#define ANY_OF_11 1

// Rays per work-item: TILE_W x TILE_H pixels of the image. 16 on CPU-class devices, 1 on GPU-class ones.
#ifndef TILE_W
#define TILE_W 4
#endif
#ifndef TILE_H
#define TILE_H 4
#endif
#define BATCH (TILE_W * TILE_H)

// Declares `name`, a pointer to a variable that stays in memory on GPUs, whose registers are for the ray on
// its way. Compilers cannot take the variable apart, since they do not know its index.
#ifdef DEVICE_INLINES_ALL
#define KEEP_IN_MEMORY(type, name)   \
  type kept_##name[1];               \
  volatile uint index_of_##name = 0; \
  type* const name = kept_##name + index_of_##name
// Clears a variable that is set on some ways only: otherwise it keeps its registers around all loops. CPUs
// lose time by it.
#define CLEARED_ON_GPUS = {0}
#else
#define KEEP_IN_MEMORY(type, name) \
  type kept_##name;                \
  type* const name = &kept_##name
#define CLEARED_ON_GPUS
#endif

// Whether the program is the tracer by itself on a GPU, where it has few registers
// (host/device/device_rules.cpp).
#if defined(TRACES_ALONE) && defined(DEVICE_INLINES_ALL)
#define FEW_REGISTERS 1
#else
#define FEW_REGISTERS 0
#endif

// 1: eight boxes or triangles per instruction, with explicit vectors. 0: one by one in rolled loops, for
// devices with one ray per lane (native vector width 1), where explicit vectors only make the program eight
// times as long.
#ifndef WIDE_VECTORS
#define WIDE_VECTORS 1
#endif
// The feature of lobes that every scene may have (shared/lobes.h).
#define HAS_SURFACES 1

// Whether rays are traced at all, not only marched through fields.
#define HAS_TRACED (HAS_MESH || HAS_SOLID)

// Whether a batch of coherent rays can traverse the BVH as one packet.
#define PACKETS (WIDE_VECTORS && BATCH == 16 && HAS_BVH)

// Whether incoherent rays are walked in lists (walk.cl).
#define WALKS_IN_TURN (WIDE_VECTORS && HAS_BVH)

// Waiting rays per work-item: enough for a full binary tree of max_depth levels, BATCH rays at a time.
#ifndef RAY_STACK
#define RAY_STACK (BATCH * 9)
#endif
// Waiting shadow rays of a surface if a work-item has one ray.
#ifndef LIGHT_ROOM
#define LIGHT_ROOM MOST_LIGHT_ROOM
#endif
// Waiting nodes of a traversal; the host computes the number.
#ifndef BVH_STACK
#define BVH_STACK 128
#endif
// Waiting groups of children on the compact tracer's way to a leaf (single.cl); the host computes the number.
#ifndef BVH_LEVELS
#define BVH_LEVELS 64
#endif
// Faces that a ray crosses together (lib/trace/stretch.cl); with one ray a lane the host computes the number.
#ifndef MOST_TOUCHING
#define MOST_TOUCHING 16u
#endif
// Maximum number of invisible interfaces (overruled by priority) between two visible ones.
#ifndef MAX_CROSSINGS
#define MAX_CROSSINGS 64
#endif

// Whether rays are counted per pixel.
#ifndef HAS_RAY_COUNTS
#define HAS_RAY_COUNTS 0
#endif

// Whether the integrator notes which objects and materials cover its pixels.
#ifndef HAS_MATTES
#define HAS_MATTES 0
#endif

// Whether paths keep the parts of their light apart (shared/light_parts.h).
#ifndef HAS_LIGHT_PARTS
#define HAS_LIGHT_PARTS 0
#endif

// Whether they keep the light of each group of lights apart instead, in the same sums.
#ifndef HAS_LIGHT_GROUPS
#define HAS_LIGHT_GROUPS 0
#endif
#define HAS_LIGHT_SUMS ANY_OF(HAS_LIGHT_PARTS, HAS_LIGHT_GROUPS)

// Whether rays carry the pixel's cone, for texture filtering.
#if HAS_MAPS && TEXTURE_KINDS
#define HAS_CONES 1
#else
#define HAS_CONES 0
#endif

// Whether surfaces keep how far they are there: where textures may say so, and layers or facets ask.
#define HAS_OPACITY ANY_OF(HAS_LAYERS, EITHER(HAS_MAPS, HAS_ROUGH, 0))

// Whether a sample needs random numbers beyond the camera's.
#define HAS_RANDOM ANY_OF(HAS_AREA_LIGHTS, HAS_ROUGH)

// Whether surfaces may test occlusion of lights by shafts (whitted/shaft_light.cl). SceneInfo.shafts says
// whether they do.
#define HAS_SHAFTS \
  (HAS_AREA_LIGHTS && !HAS_SDF && !HAS_OBJECT_MOTION && !HAS_RELIEF && !HAS_PARALLAX && !HAS_LAYERS)

// Whether paths are traced, which meet lights by chance as well.
#ifndef HAS_PATHS
#define HAS_PATHS 0
#endif
#define HAS_LAYERED_FILTERS (HAS_LAYERS && HAS_LAYER_FILTERS)

// Whether rays continue behind surfaces: interfaces that they do not see, or filters.
#define HAS_CROSSINGS ANY_OF(HAS_MEDIA, ANY_OF(HAS_SHADOW_FILTERS, HAS_CATCHERS))

// Whether rays have a time.
#define HAS_MOTION ANY_OF(HAS_CAMERA_MOTION, HAS_OBJECT_MOTION)
