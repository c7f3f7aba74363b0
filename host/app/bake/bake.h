// Maps of a detailed model for a plain one: rays from the plain model's surface to the detailed one, traced
// on a device.
#pragma once
#include <functional>

#include "app/bake/low_model.h"
#include "base/pixels/stored_image.h"
#include "bench/rays/ray_tracer.h"

namespace sundog {

enum class BakeKind { normal, height, occlusion };

struct BakeSettings {
  BakeKind kind = BakeKind::normal;
  double cage = 0;   // how far before and behind the plain model's surface the detailed one is looked for
  int samples = 64;  // rays of occlusion from each texel
};

struct BakedMap {
  StoredImage image;               // normal: RGBA of 8 bits; height: grey of 16; occlusion: grey of 8
  std::size_t missed = 0;          // covered texels whose rays met nothing
  double lowest = 0, highest = 0;  // of the heights, in the world
};

/// `high` is compiled from the detailed model. `progress` hears how much of the texels is done.
BakedMap bake(const CompiledScene& high, RayTracer& tracer, const std::vector<LowTriangle>& low,
              const Coverage& coverage, const BakeSettings& settings,
              const std::function<void(std::size_t done)>& progress);

/// Gives texels without a value the mean of neighbours that have one, ring by ring, `rings` times, so that
/// filters find no seam at the edges of islands.
void dilate(StoredImage& image, std::vector<bool>& filled, int rings);

}  // namespace sundog
