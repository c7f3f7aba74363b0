// The cost of textures: times of a scene's frame with and without them, and of loading its images.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "bench/report/report.h"
#include "bench/runs/measure.h"
#include "device/devices.h"
#include "scene/description.h"

namespace sundog {

/// The scene with the numbers and colours of its materials alone.
SceneDescription without_textures(SceneDescription scene);

/// Eight solids on a floor, each with a colour image of its own, `edge` texels a side, trilinear; two lights,
/// two mirrors. The images are made here.
SceneDescription eight_textures(int edge);

/// Frames with a scene's textures and without them, in turn, by the time of their kernels.
class TextureCost {
 public:
  TextureCost(std::string scene_name, const SceneDescription& scene, const DeviceInfo& device);
  void measure(const MeasureOptions& options) { sundog::measure(subjects_, options); }
  void add_to(Report& report) const;

 private:
  std::string scene_, device_;
  std::vector<Subject> subjects_;              // without textures, with them
  std::vector<std::shared_ptr<double>> rays_;  // of a frame of each
};

/// Loading eight PNG files of `edge` texels a side, from their bytes to the tables of texels: decoding, and
/// the rest, which is smaller levels and tiles.
class ImageCost {
 public:
  explicit ImageCost(int edge);
  void measure(const MeasureOptions& options) { sundog::measure(subjects_, options); }
  void add_to(Report& report) const;

 private:
  struct Parts {
    std::vector<double> decode, levels, processor;  // seconds of each run, the first one too
  };
  int edge_;
  std::shared_ptr<Parts> parts_;
  std::vector<Subject> subjects_;
};

}  // namespace sundog
