// `sundog bench textures`: times a frame with and without textures.
#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "bench/commands/bench_run.h"
#include "bench/frames/frame_runner.h"
#include "bench/report/machine.h"
#include "bench/report/report.h"
#include "bench/runs/measure.h"
#include "bench/runs/ratio.h"
#include "compile/compiled_scene.h"
#include "device/devices.h"
#include "scene/description.h"

namespace sundog {
namespace {

/// The scene with only its materials' plain colours and numbers.
SceneDescription without_textures(SceneDescription scene) {
  for (MaterialDescription& material : scene.materials) {
    material.textures = {};
    material.metal_rough.reset();
    material.cutoff = 0;
    material.parallax = 0;
  }
  scene.textures.clear();
  scene.images.clear();
  return scene;
}

/// Times frames with and without a scene's textures, in turn, by their kernels' time.
class TextureCost {
 public:
  TextureCost(std::string scene_name, const SceneDescription& scene, const DeviceInfo& device)
      : scene_(std::move(scene_name)), device_(device_title(device)) {
    const auto add = [&](const char* what, const SceneDescription& described) {
      const auto flat = std::make_shared<const CompiledScene>(compile(described));
      const auto rays = rays_.emplace_back(std::make_shared<double>());
      const auto open = [=] {
        return std::make_shared<FrameRunner>(std::vector{frame_worker(device, flat)}, flat);
      };
      subjects_.push_back(frame_subject(fmt::format("{} on {}, {}", scene_, device_, what),
                                        {open,
                                         [rays](const FrameRunner& frames) { *rays = frames.rays(); },
                                         [](const FrameRunner& frames) { return frames.kernel_seconds(); },
                                         {device}}));
    };
    add("without", without_textures(scene));
    add("textured", scene);
  }

  void measure(const MeasureOptions& options) { sundog::measure(subjects_, options); }
  void add_to(Report& report) const {
    const Ratio ratio = paired_ratio(subjects_[0].runs, subjects_[1].runs);
    Table table{fmt::format("{} on {}", scene_, device_), {}, {}};
    BarPlot bars{table.title + ": kernels of a frame", "ms", {}};
    for (std::size_t i = 0; i < 2; ++i) {
      const Subject& subject = subjects_[i];
      const Field textures{"textures", "", i ? "with" : "without"};
      std::vector<Field> more{{"rays", "", subject.is_good() ? Cell(*rays_[i]) : Cell()}};
      if (i && ratio.is_known() && subjects_[0].is_good() && subject.is_good())
        more.push_back({"ratio", "", Spread{ratio.value, ratio.low, ratio.high}});
      std::vector<Field> shown{textures, {"time", "ms", milliseconds(subject)}};
      shown.insert(shown.end(), more.begin(), more.end());
      add_row(table, shown, subject);
      add_measured(report, subject, {{"scene", "", scene_}, {"device", "", device_}, textures}, more);
      if (subject.is_good())
        bars.bars.push_back({textures.cell.word + " textures", scaled(subject.seconds(), 1e3), ""});
    }
    report.parts.emplace_back(std::move(table));
    report.parts.emplace_back(std::move(bars));
  }

 private:
  std::string scene_, device_;
  std::vector<Subject> subjects_;              // without textures, with textures
  std::vector<std::shared_ptr<double>> rays_;  // of a frame of each subject
};

int bench_textures(const BenchOptions& options) {
  BenchRun run("textures", "What textures cost", options);
  run.head().times_frames = true;
  run.head().notes.emplace_back(
      "Medians of frames of each after one to warm up, in turn; times are those of the kernels. `ratio` is "
      "the median of the ratios of runs that followed each other, with textures over without. Without "
      "textures the materials keep their colors and numbers. Every result was compared before its time "
      "counted.");
  const std::vector<DeviceInfo> devices = run.devices();
  for (const std::string& file : options.scenes) {
    const SceneDescription scene = bench_description(file, options);
    run.add_scene(file, compile(scene));
    for (const DeviceInfo& device : devices)
      run.measure(std::make_shared<TextureCost>(scene_name(options, file), scene, device));
  }
  return run.publish();
}

}  // namespace

void add_bench_textures(Arguments& bench, Command& chosen) {
  const auto options = std::make_shared<BenchOptions>();
  add_bench_size(add_bench_command(bench, chosen, "textures", "A frame with textures and without them",
                                   options, bench_textures),
                 *options);
}

}  // namespace sundog
