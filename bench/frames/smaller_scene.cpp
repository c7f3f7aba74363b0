// Grows a tiny frame until its time predicts how large a frame fits into the given seconds.
#include "bench/frames/smaller_scene.h"

#include <algorithm>
#include <cmath>

namespace sundog {
namespace {

constexpr double least_seconds = 0.05;    // of the frames that are returned
constexpr double telling_seconds = 0.01;  // of a frame whose time is not mostly launch overhead
constexpr double first_pixels = 512, growth = 16;

double pixels_of(const SceneInfo& info) { return static_cast<double>(info.width) * info.height; }

u32 scaled(u32 value, double by) {
  return std::max(1u, static_cast<u32>(std::lround(static_cast<double>(value) * by)));
}

/// The camera's step to the next pixel after `before` pixels have become `after`.
float4 stretched(const float4& step, u32 before, u32 after) {
  const float by = static_cast<float>(before) / static_cast<float>(after);
  return {step.x * by, step.y * by, step.z * by, step.w * by};
}

}  // namespace

CompiledScene smaller_scene(const CompiledScene& scene, double pixels, double samples) {
  CompiledScene smaller = scene;
  SceneInfo& info = smaller.info;
  const double by = std::sqrt(std::min(1.0, pixels / pixels_of(scene.info)));
  info.width = scaled(info.width, by);
  info.height = scaled(info.height, by);
  info.camera_dx = stretched(info.camera_dx, scene.info.width, info.width);
  info.camera_dy = stretched(info.camera_dy, scene.info.height, info.height);
  info.samples = std::clamp(static_cast<u32>(std::min(samples, 1e9)), 1u, info.samples);
  return smaller;
}

CompiledScene scene_in_time(const CompiledScene& scene, double seconds,
                            const std::function<double(const CompiledScene&)>& measure) {
  const double wanted = std::max(seconds, least_seconds), all = pixels_of(scene.info);
  double per_pixel = 0;
  for (double pixels = std::min(first_pixels, all);; pixels = std::min(growth * pixels, all)) {
    const CompiledScene small = smaller_scene(scene, pixels, 1);
    const double measured = measure(small);
    per_pixel = measured / pixels_of(small.info);
    if (measured >= telling_seconds || pixels >= all) break;
  }
  return smaller_scene(scene, wanted / per_pixel, wanted / (per_pixel * all));
}

}  // namespace sundog
