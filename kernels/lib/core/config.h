// Every constant that a device specialises a kernel by, with its default, and what follows from the features
// of a scene (shared/features.h, shared/shapes.h; HAS_MESH, HAS_SPHERE, ...: it has that shape; HAS_BVH: rays
// go through a BVH). The host's KernelConfig writes the -D options. Thresholds of a method stand where the
// method does.
#ifndef SUNDOG_LIB_CONFIG_H
#define SUNDOG_LIB_CONFIG_H
#include "shared/shapes.h"

#pragma OPENCL FP_CONTRACT OFF
#ifdef __clang__
// Vectors wider than the processor's are no fault: all functions are inlined, or called within one program.
#pragma clang diagnostic ignored "-Wpsabi"
#endif

// Without the instruction fma() is a program of its own, inlined at every use (rusticl took 12 times as long
// to compile); two roundings are as good here. PoCL does not define FP_FAST_FMAF, but names the host's
// __FMA__; for other devices than processors the host defines DEVICE_HAS_FMA where the driver says so.
#if defined(FP_FAST_FMAF) || defined(__FMA__) || defined(DEVICE_HAS_FMA)
#define HAS_FMA 1
#else
#define HAS_FMA 0
#define fma(a, b, c) ((a) * (b) + (c))
#endif

// For the inner loops: a call there would save and restore every vector register.
// Not without optimisation: Oclgrind does not know the marks that inlining leaves.
#ifdef __NO_INLINE__
#define ALWAYS_INLINE static inline
#else
#define ALWAYS_INLINE static inline __attribute__((always_inline))
#endif

// For the body of a kernel: PoCL compiles what stands in a kernel three times (the kernel, and two loops over
// its work-groups), a function once; and it keeps the private arrays of a kernel apart for each work-item of
// a group, those of a function once. Such a function takes no index from get_global_id(), or PoCL inlines it.
// Also for what is called from several places, where copies would be compiled for longer than a call takes.
#define NEVER_INLINE static __attribute__((noinline))

// Rays a work-item carries together: TILE_W x TILE_H pixels of the image. 16 on CPU-class devices, 1 on
// GPU-class ones.
#ifndef TILE_W
#define TILE_W 4
#endif
#ifndef TILE_H
#define TILE_H 4
#endif
#define BATCH (TILE_W * TILE_H)

// 1: eight boxes or triangles an instruction, with explicit vectors. 0: one by one in rolled loops, for
// devices that run a lane a ray (native vector width 1), where explicit vectors only make the program eight
// times as long.
#ifndef WIDE_VECTORS
#define WIDE_VECTORS 1
#endif
// Whether there is anything that rays are traced to, and not only fields that they march to.
#define HAS_TRACED (HAS_MESH || HAS_SOLID)

// Whether a batch of rays that run close together can go through the BVH as one.
#define PACKETS (WIDE_VECTORS && BATCH == 16 && HAS_BVH)

// Whether rays that go by themselves are walked in lists (walk.cl).
#define WALKS_IN_TURN (WIDE_VECTORS && HAS_BVH)

// Pending rays of a work-item: enough for a full binary tree of max_depth levels walked BATCH rays at a time.
#ifndef RAY_STACK
#define RAY_STACK (BATCH * 9)
#endif
// Shadow rays of a surface that wait at a time, where a work-item has one ray.
#ifndef LIGHT_ROOM
#define LIGHT_ROOM 16
#endif
// Nodes that wait during a traversal; the host computes what the scene needs.
#ifndef BVH_STACK
#define BVH_STACK 128
#endif
// Invisible interfaces (overruled by priority) that one ray may cross between two visible ones.
#ifndef MAX_CROSSINGS
#define MAX_CROSSINGS 64
#endif

// Whether the rays of each pixel are counted.
#ifndef HAS_RAY_COUNTS
#define HAS_RAY_COUNTS 0
#endif

// Whether rays carry the cone that a pixel sees, by which textures are filtered.
#define HAS_CONES (HAS_MAPS && TEXTURE_KINDS)

// Whether a sample needs random numbers beyond the camera's.
#define HAS_RANDOM (HAS_AREA_LIGHTS || HAS_ROUGH)

// Whether surfaces may ask by shafts what stands before a light (light/direct_light.cl). The scene says
// whether they do: SceneInfo.shafts.
#define HAS_SHAFTS \
  (HAS_AREA_LIGHTS && !HAS_SDF && !HAS_OBJECT_MOTION && !HAS_RELIEF && !HAS_PARALLAX && !HAS_LAYERS)

// Whether rays continue behind surfaces: interfaces that they do not see, or filters.
#define HAS_CROSSINGS (HAS_MEDIA || HAS_SHADOW_FILTERS)

#endif
