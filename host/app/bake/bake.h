// Bakes a map of a detailed model for a plain one: traces rays between their surfaces on a device.
#pragma once
#include <functional>

#include "app/bake/low_model.h"
#include "base/pixels/stored_image.h"
#include "bench/rays/ray_tracer.h"

namespace sundog {

enum class BakeKind { normal, height, occlusion };

struct BakeSettings {
  BakeKind kind = BakeKind::normal;
  double cage = 0;   // how far outside and inside the plain surface rays look for the detailed one
  int samples = 64;  // occlusion rays per texel
};

struct BakedMap {
  StoredImage image;               // normal: 8-bit RGBA; height: 16-bit grey; occlusion: 8-bit grey
  std::size_t missed = 0;          // covered texels whose rays hit nothing
  double lowest = 0, highest = 0;  // range of heights, in world units
};

/// `high` is compiled from the detailed model. `progress` receives the number of texels done so far.
BakedMap bake(const CompiledScene& high, RayTracer& tracer, const std::vector<LowTriangle>& low,
              const Coverage& coverage, const BakeSettings& settings,
              const std::function<void(std::size_t done)>& progress);

/// Fills texels without a value with the mean of their filled neighbours, ring by ring, `rings` times, so
/// that texture filters show no seams at the edges of UV islands.
void dilate(StoredImage& image, std::vector<bool>& filled, int rings);

}  // namespace sundog
