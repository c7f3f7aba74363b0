// The operations and bytes that rays need, counted: where the tracer lies under a device's roofline.
#pragma once
#include "bench/rays/ray_sets.h"

namespace sundog {

/// Mean work of a ray. Each ray walks alone through the scene's tree, near children first (bench/plain).
/// Nodes and triangles that it visits count as the kernels have them, with an fma as two operations;
/// comparisons, minima, integers, work after a hit and the equations of solids do not count.
struct RayWork {
  double nodes = 0, blocks = 0, instances = 0;  // that it comes to
  double operations = 0;
  double bytes = 0;  // that it asks for, from memory or a cache
  double least_bytes =
      0;  // that all rays together cannot do without: each entry of a table once, rays, results

  double intensity() const { return operations / bytes; }
};

/// `compact`: by the compact tracer, one box and one triangle at a time; else by vectors of eight.
RayWork ray_work(const CompiledScene& scene, const RaySet& set, bool compact);

}  // namespace sundog
