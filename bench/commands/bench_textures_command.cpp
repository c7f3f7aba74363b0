// `sundog bench textures`: a frame with textures and without, and the time that images take to load.
#include <fmt/format.h>

#include <memory>

#include "app/options/option_helpers.h"
#include "bench/commands/bench_run.h"
#include "bench/frames/texture_cost.h"

namespace sundog {
namespace {

struct TexturesOptions : BenchOptions {
  int edge = 1024;         // of the made scene's images
  int loaded_edge = 2048;  // of those that are loaded
};

int bench_textures(const TexturesOptions& options) {
  BenchRun run("textures", "What textures cost", options);
  run.head().notes.push_back(fmt::format(
      "Median of {} frames of each after one to warm up, in turn; times are those of the kernels, "
      "and the ratio is of the medians. Without textures the materials keep their colors and "
      "numbers. Levels: all that compiling the scene takes, mostly the smaller levels of the "
      "images. Loading: both. Every result was compared before its time counted.",
      options.repeat));
  const std::vector<DeviceInfo> devices = run.devices();
  const auto measure = [&](const std::string& name, const std::string& file, const SceneDescription& scene) {
    run.add_scene(name, file, compile(scene));
    for (const DeviceInfo& device : devices) run.measure(std::make_shared<TextureCost>(name, scene, device));
  };
  for (const std::string& file : options.scenes)
    measure(scene_name(file), file, bench_description(file, options));
  if (options.scenes.empty()) {
    measure(fmt::format("eight {0}x{0}", options.edge), "", sized(eight_textures(options.edge), options));
    run.measure(std::make_shared<ImageCost>(options.loaded_edge));
  }
  return run.publish();
}

}  // namespace

void add_bench_textures(Arguments& bench, Command& chosen) {
  const auto options = std::make_shared<TexturesOptions>();
  Arguments* app = add_bench_command(bench, chosen, "textures", "A frame with textures and without them",
                                     options, bench_textures, false);
  add_bench_size(app, *options);
  value(app, "--edge", "N", options->edge, "texels a side of the made scene's images (default 1024)")
      ->range(1, 8192);
  value(app, "--loaded-edge", "N", options->loaded_edge,
        "texels a side of the PNG files whose loading is timed (default 2048)")
      ->range(1, 8192);
}

}  // namespace sundog
