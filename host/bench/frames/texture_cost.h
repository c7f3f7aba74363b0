// What textures cost: a scene's frame with its textures and without them, and the time that its images take
// to load.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "bench/report/report.h"
#include "device/devices.h"
#include "scene/description.h"

namespace sundog {

/// The scene with the numbers and colours of its materials alone.
SceneDescription without_textures(SceneDescription scene);

/// Eight solids on a floor, each with a colour image of its own, `edge` texels a side, trilinear; two lights,
/// two mirrors. The images are made here.
SceneDescription eight_textures(int edge);

struct TextureCost {
  Spread textured, plain;  // seconds of kernels in a frame
  double ratio = 0;        // the median over the pairs
  double ratio_low = 0, ratio_high = 0;
  double rays_textured = 0, rays_plain = 0;
};

/// Renders both once to warm up, then `repeat` times in turn.
TextureCost measure_texture_cost(const SceneDescription& scene, const DeviceInfo& device, int repeat,
                                 const std::function<void(const std::string&)>& on_step);

/// What loading eight PNG files of `edge` texels a side takes, from their bytes to the tables of texels, in
/// seconds: decoding, and the rest, which is smaller levels and tiles.
struct ImageCost {
  Spread decode, levels, both, processor;  // the last: processor time of both
};
ImageCost measure_image_cost(int edge, int repeat, const std::function<void(const std::string&)>& on_step);

void add_texture_rows(Report& report, const std::string& scene, const DeviceInfo& device,
                      const TextureCost& cost);
void add_image_rows(Report& report, int edge, const ImageCost& cost);

}  // namespace sundog
