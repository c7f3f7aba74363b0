// Times whole frames of sundog and POV-Ray in turn, with the same scene, size, depth, cut-off and number of
// threads, at one sample a pixel; prints medians of processor time. Transmissive objects cast opaque shadows,
// because the programs filter light by different models. A time counts only if the two pictures are alike.
// Without POV-Ray, measures sundog alone and says so.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <thread>

#include "base/arguments.h"
#include "base/environment.h"
#include "base/file.h"
#include "base/image_compare.h"
#include "base/image_io.h"
#include "bench/frames/frame_runner.h"
#include "compile/compiled_scene.h"
#include "device/devices.h"
#include "peer_program.h"
#include "povray_from_scene.h"
#include "povray_run.h"
#include "scene/load.h"

namespace sundog {
namespace {

struct Options {
  std::vector<std::string> scenes{SUNDOG_SOURCE_DIR "/scenes/spheres.json",
                                  SUNDOG_SOURCE_DIR "/bench/scenes/ice_boxes.json",
                                  SUNDOG_SOURCE_DIR "/bench/scenes/ice_mesh.json"};
  int size = 640, repeat = 5;
  unsigned threads = std::max(1u, std::thread::hardware_concurrency());
  double tolerance = 0.02;  // sundog filters checkers, POV-Ray does not
  std::string json, folder = "against_povray";
};

// Seconds per thread. `frame`: ray tracing until the picture is complete. `whole`: also reading the scene and
// building its trees, but not starting the program, opening devices or building kernels.
struct Times {
  std::vector<double> frame, whole;
};

struct Measured {
  std::string scene;
  Times ours, theirs;
  RayCounts rays{};
  std::uint64_t their_rays = 0, their_shadow_tests = 0;
  ImageDifference difference;
};

SceneDescription load(const Options& options, const std::string& name) {
  std::vector<std::string> overrides{fmt::format("/image/width={}", options.size),
                                     fmt::format("/image/height={}", options.size), "/render/samples=1"};
  // POV-Ray has no medium priorities, so the liquid must end close to the cavity's wall.
  if (std::filesystem::path(name).stem() == "hollow_ice")
    overrides.emplace_back("/meshes/liquid/generate/wall=0.02");
  SceneDescription scene = load_scene(name, overrides);
  for (MaterialDescription& material : scene.materials)
    if (material.transmission != dvec3(0)) material.shadow_opaque = true;
  return scene;
}

void time_ours(const Options& options, const std::string& name, FrameRunner& runner, Times& times) {
  const Elapsed prepared = elapsed([&] { compile(load(options, name)); });
  const Elapsed frame = elapsed([&] { runner.run(); });
  times.frame.push_back(frame.processor / options.threads);
  times.whole.push_back(times.frame.back() + prepared.processor);
}

povray::Run time_theirs(const Options& options, const std::string& scene, const std::string& name,
                        Times& times) {
  povray::Run run =
      povray::run(scene, options.size, options.size, static_cast<int>(options.threads), options.folder, name);
  times.frame.push_back(run.cpu_seconds / options.threads);
  times.whole.push_back(times.frame.back() + run.parse_seconds);
  return run;
}

// Saves sundog's picture beside POV-Ray's and returns their difference. Throws if they are not alike.
ImageDifference compare(const Options& options, const std::string& name, Image ours, const Image& theirs) {
  for (float& value : ours.data) value = std::clamp(value, 0.0f, 1.0f);  // POV-Ray's picture ends at 1
  write_image(ours, std::filesystem::path(options.folder) / (name + "_sundog.png"));
  const ImageDifference difference = compare_images(ours, theirs, 0.01);
  if (difference.mean > options.tolerance)
    throw std::runtime_error(
        fmt::format("{}: the pictures in {} differ by {:.4f} in the mean, more than {}: no time counts", name,
                    options.folder, difference.mean, options.tolerance));
  return difference;
}

Measured measure(const Options& options, const std::string& name, const DeviceInfo& device,
                 bool with_povray) {
  Measured m;
  m.scene = std::filesystem::path(name).stem();
  const SceneDescription description = load(options, name);
  const std::string scene = povray::from_scene(description, povray::Absorption::fade);
  const CompiledScene compiled = compile(description);
  FrameRunner runner(device, compiled);
  runner.run();
  for (int i = 0; i < options.repeat; i++) {
    time_ours(options, name, runner, m.ours);
    m.rays = runner.counts();
    if (!with_povray) continue;
    const povray::Run theirs = time_theirs(options, scene, m.scene, m.theirs);
    m.their_rays = theirs.rays;
    m.their_shadow_tests = theirs.shadow_tests;
    if (i == 0) m.difference = compare(options, m.scene, runner.image(), theirs.image);
  }
  return m;
}

nlohmann::json figures(const Times& times) {
  return {{"frame_seconds", to_json(spread(times.frame))}, {"whole_seconds", to_json(spread(times.whole))}};
}

nlohmann::json to_json(const Measured& m, bool with_povray) {
  nlohmann::json out{{"scene", m.scene}, {"sundog", figures(m.ours)}};
  out["sundog"]["rays"] = {{"primary", m.rays[COUNT_PRIMARY]},
                           {"reflection", m.rays[COUNT_REFLECTION]},
                           {"refraction", m.rays[COUNT_REFRACTION]},
                           {"shadow", m.rays[COUNT_SHADOW]}};
  if (!with_povray) return out;
  out["povray"] = figures(m.theirs);
  out["povray"]["rays"] = {{"all_but_shadow", m.their_rays}, {"shadow_tests", m.their_shadow_tests}};
  out["difference"] = {{"mean", m.difference.mean}, {"over_0.01", m.difference.over_tolerance}};
  out["frame_ratio"] = to_json(ratio(m.theirs.frame, m.ours.frame));
  out["whole_ratio"] = to_json(ratio(m.theirs.whole, m.ours.whole));
  return out;
}

// POV-Ray counts a shadow ray again after each transmissive surface.
void print_line(const std::string& what, const std::string& who, const Times& t, std::uint64_t rays,
                std::uint64_t shadow) {
  const Spread frame = spread(t.frame);
  fmt::print("{:16} {:8}{:8.3f} ({:.3f}..{:.3f}){:9.3f}{:9.2f}{:9.2f}\n", what, who, frame.median, frame.min,
             frame.max, spread(t.whole).median, static_cast<double>(rays) / 1e6,
             static_cast<double>(shadow) / 1e6);
}

void print(const Measured& m, bool with_povray) {
  const std::uint64_t rays = m.rays[COUNT_PRIMARY] + m.rays[COUNT_REFLECTION] + m.rays[COUNT_REFRACTION];
  print_line(m.scene, "sundog", m.ours, rays, m.rays[COUNT_SHADOW]);
  if (with_povray) {
    print_line("", "POV-Ray", m.theirs, m.their_rays, m.their_shadow_tests);
    const Spread frame = ratio(m.theirs.frame, m.ours.frame);
    fmt::print(
        "{:16} {:8}{:8.2f} ({:.2f}..{:.2f}){:9.2f}   pictures differ by {:.5f}, {} pixels by more than "
        "0.01\n",
        "", "ratio", frame.median, frame.min, frame.max, ratio(m.theirs.whole, m.ours.whole).median,
        m.difference.mean, m.difference.over_tolerance);
  }
  std::fflush(stdout);
}

// The default device, or a part of it with as many compute units as POV-Ray gets threads.
DeviceInfo choose_device(unsigned threads) {
  DeviceInfo device = select_devices(enumerate_devices(plain_environment()), {}).at(0);
  if (threads < device.compute_units) device.sub_units = threads;
  return device;
}

void run(const Options& options) {
  const std::string version = povray::installed_version();
  const DeviceInfo device = choose_device(options.threads);
  fmt::print("{}, driver {}; {}\n{} threads, {}x{}, {} runs in turn; seconds of processor time a thread\n",
             device.label(), device.driver,
             version.empty() ? "POV-Ray is not installed (apt-get install povray)" : "POV-Ray " + version,
             options.threads, options.size, options.size, options.repeat);
  fmt::print("{:16} {:8}{:>8}{:>24}{:>9}{:>9}\n", "", "", "frame", "whole", "M rays", "M shadow");
  nlohmann::json report{{"device", device.label()},
                        {"driver", device.driver},
                        {"povray", version},
                        {"threads", options.threads},
                        {"size", options.size}};
  for (const std::string& scene : options.scenes) {
    const Measured m = measure(options, scene, device, !version.empty());
    print(m, !version.empty());
    report["scenes"].push_back(to_json(m, !version.empty()));
  }
  if (!options.json.empty()) write_file(options.json, report.dump(2) + "\n");
}

}  // namespace
}  // namespace sundog

int main(int argc, char** argv) {
  sundog::Options options;
  sundog::Arguments app{"Times whole frames of sundog and POV-Ray in turn"};
  app.add_option("SCENE", options.scenes, "scene files (default: spheres, ice_boxes, ice_mesh)");
  app.add_option("--size", options.size, "pixels a side (default 640)")->positive();
  app.add_option("--repeat", options.repeat, "runs of each")->positive();
  app.add_option("--threads", options.threads, "of each (default: the machine's)")->positive();
  app.add_option("--tolerance", options.tolerance, "mean difference up to which pictures are alike");
  app.add_option("--json", options.json, "file for the figures");
  app.add_option("--folder", options.folder, "for the pictures and POV-Ray's files");
  return run_program(app, argc, argv, [&] { sundog::run(options); });
}
