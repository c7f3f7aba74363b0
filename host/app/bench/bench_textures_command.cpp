// `sundog bench textures`: a frame with textures and without, and the time that images take to load.
#include <fmt/format.h>

#include <memory>

#include "app/bench/bench_options.h"
#include "app/options/option_helpers.h"
#include "bench/frames/texture_cost.h"

namespace sundog {
namespace {

struct TexturesOptions : BenchOptions {
  int edge = 1024;         // of the made scene's images
  int loaded_edge = 2048;  // of those that are loaded
};

int bench_textures(const TexturesOptions& options) {
  Report report = new_report("textures", "What textures cost", options);
  const std::vector<DeviceInfo> devices = bench_devices(options);
  add_device_facts(report, devices);
  const auto measure = [&](const std::string& name, const SceneDescription& scene) {
    for (const DeviceInfo& device : devices) {
      const auto on_step = [&](const std::string& step) {
        show_step(options, fmt::format("{}, {}", name, step));
      };
      add_texture_rows(report, name, device, measure_texture_cost(scene, device, options.repeat, on_step));
    }
  };
  for (const std::string& file : options.scenes) measure(scene_name(file), bench_description(file, options));
  if (options.scenes.empty()) {
    measure(fmt::format("eight {0}x{0}", options.edge), sized(eight_textures(options.edge), options));
    const auto on_step = [&](const std::string& step) { show_step(options, step); };
    add_image_rows(report, options.loaded_edge,
                   measure_image_cost(options.loaded_edge, options.repeat, on_step));
  }
  report.notes.push_back(
      fmt::format("Median of {} pairs of frames after one each to warm up, in turn; times are those of the "
                  "kernels, and the ratio is the median of the pairs'. Without textures the materials keep "
                  "their colors and numbers. Levels: all that compiling the scene takes, mostly the smaller "
                  "levels of the images. Loading: both.",
                  options.repeat));
  return publish(report, options);
}

}  // namespace

void add_bench_textures(Arguments& bench, Command& chosen) {
  const auto options = std::make_shared<TexturesOptions>();
  Arguments* app = bench.add_subcommand("textures", "A frame with textures and without them");
  add_bench_options(app, *options, false);
  add_bench_size(app, *options);
  app->add_option("--edge", options->edge, "texels a side of the made scene's images (default 1024)")
      ->type_name("N")
      ->range(1, 8192);
  app->add_option("--loaded-edge", options->loaded_edge,
                  "texels a side of the PNG files whose loading is timed (default 2048)")
      ->type_name("N")
      ->range(1, 8192);
  app->callback([options, &chosen] { chosen = RunLater{[options] { return bench_textures(*options); }}; });
}

}  // namespace sundog
