// Counts the operations and bytes that rays need, which place the tracer under a device's roofline.
#pragma once
#include "bench/rays/ray_sets.h"

namespace sundog {

/// Mean work of a ray. Each ray traverses the scene's tree alone, near children first (bench/plain). The
/// nodes and triangles that it visits count as in the kernels, an fma as two operations; comparisons, minima,
/// integer operations, work after a hit and the equations of solids do not count.
struct RayWork {
  double nodes = 0, blocks = 0, instances = 0;  // visited
  double operations = 0;
  double bytes = 0;        // requested, from memory or a cache
  double least_bytes = 0;  // its share if each table entry comes from memory once, plus ray and result

  double intensity() const { return operations / bytes; }
};

/// `compact`: by the compact tracer, one box and one triangle at a time; otherwise by the wide one, in
/// vectors of eight.
RayWork ray_work(const CompiledScene& scene, const RaySet& set, bool compact);

}  // namespace sundog
