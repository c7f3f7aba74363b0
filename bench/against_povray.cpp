// Whole frames against POV-Ray: the same scene, size, depth, cut-off, samples and number of threads, in turn,
// medians. A time counts only if the two pictures are alike. Without POV-Ray it says so and measures sundog
// alone.
#include <fmt/format.h>

#include <algorithm>
#include <CLI/CLI.hpp>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "base/clock.h"
#include "base/error.h"
#include "base/file.h"
#include "base/image_compare.h"
#include "compile/compiled_scene.h"
#include "device/devices.h"
#include "povray_from_scene.h"
#include "povray_run.h"
#include "render/render.h"
#include "scene/load.h"

namespace sundog {
namespace {

struct Options {
  std::vector<std::string> scenes{SUNDOG_SOURCE_DIR "/scenes/hollow_ice.json",
                                  SUNDOG_SOURCE_DIR "/scenes/spheres.json"};
  int width = 640, height = 480, repeat = 5;
  unsigned threads = std::max(1u, std::thread::hardware_concurrency());
  std::string json, folder = "against_povray";
};

// Seconds. `frame` is ray tracing with its transfers; `whole` adds reading the scene and building its trees,
// without the start of the program and, on our side, without building kernels (they come from the cache).
struct Times {
  std::vector<double> frame, whole;
};

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
}

struct Measured {
  std::string scene;
  Times ours, theirs;
  RayCounts rays{};
  std::uint64_t their_rays = 0, their_shadow_tests = 0;
  double difference = 0;  // mean, of the two pictures
  double frame_ratio() const { return median(theirs.frame) / median(ours.frame); }
  double whole_ratio() const { return median(theirs.whole) / median(ours.whole); }
};

std::vector<std::string> overrides(const Options& options, const std::string& scene) {
  std::vector<std::string> result{fmt::format("/image/width={}", options.width),
                                  fmt::format("/image/height={}", options.height), "/render/samples=1"};
  // POV-Ray has no priorities, so there the liquid must end close to the cavity's wall.
  if (std::filesystem::path(scene).stem() == "hollow_ice")
    result.emplace_back("/meshes/liquid/generate/wall=0.02");
  return result;
}

RenderResult time_ours(const Options& options, const std::string& file,
                       const std::vector<DeviceInfo>& devices, Times& times) {
  const Stopwatch clock;
  const CompiledScene compiled = compile(load_scene(file, overrides(options, file)));
  const double prepared = clock.seconds();
  RenderResult result = render(compiled, devices);
  const double frame = result.times.upload + result.times.render + result.times.readback;
  times.frame.push_back(frame);
  times.whole.push_back(prepared + frame);
  return result;
}

povray::Run time_theirs(const Options& options, const std::string& scene, const std::string& name,
                        Times& times) {
  povray::Run run = povray::run(scene, options.width, options.height, static_cast<int>(options.threads),
                                options.folder, name);
  times.frame.push_back(run.seconds);
  times.whole.push_back(run.seconds + run.parse_seconds);
  return run;
}

Measured measure(const Options& options, const std::string& file, const std::vector<DeviceInfo>& devices,
                 bool with_povray) {
  Measured m;
  m.scene = std::filesystem::path(file).stem();
  const std::string scene =
      povray::from_scene(load_scene(file, overrides(options, file)), povray::Absorption::fade);
  Times warm_up;
  time_ours(options, file, devices, warm_up);
  for (int i = 0; i < options.repeat; i++) {
    const RenderResult ours = time_ours(options, file, devices, m.ours);
    m.rays = ours.counts;
    if (!with_povray) continue;
    const povray::Run theirs = time_theirs(options, scene, m.scene, m.theirs);
    m.their_rays = theirs.rays;
    m.their_shadow_tests = theirs.shadow_tests;
    Image clamped = ours.image;
    for (float& value : clamped.data) value = std::clamp(value, 0.0f, 1.0f);
    m.difference = compare_images(clamped, theirs.image, 0.01).mean;
    if (m.difference > 0.08)
      throw std::runtime_error(
          fmt::format("{}: the pictures differ by {:.3f} in the mean: no time counts", file, m.difference));
  }
  return m;
}

nlohmann::json figures(const Times& times) {
  return {{"frame_seconds", times.frame},
          {"whole_seconds", times.whole},
          {"frame_median", median(times.frame)},
          {"whole_median", median(times.whole)}};
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
  out["mean_difference"] = m.difference;
  out["frame_ratio"] = m.frame_ratio();
  out["whole_ratio"] = m.whole_ratio();
  return out;
}

// Shadow rays apart: POV-Ray counts a shadow ray anew behind each transmissive surface.
void print_line(const std::string& what, const std::string& who, const Times& t, std::uint64_t rays,
                std::uint64_t shadow) {
  fmt::print(
      "{:18} {:8} frame {:7.3f} s ({:.3f}..{:.3f})  whole {:7.3f} s  {:6.2f} M rays and {:.2f} M shadow "
      "rays\n",
      what, who, median(t.frame), *std::min_element(t.frame.begin(), t.frame.end()),
      *std::max_element(t.frame.begin(), t.frame.end()), median(t.whole), static_cast<double>(rays) / 1e6,
      static_cast<double>(shadow) / 1e6);
}

void print(const Measured& m, bool with_povray) {
  const std::uint64_t rays = m.rays[COUNT_PRIMARY] + m.rays[COUNT_REFLECTION] + m.rays[COUNT_REFRACTION];
  print_line(m.scene, "sundog", m.ours, rays, m.rays[COUNT_SHADOW]);
  if (!with_povray) return;
  print_line("", "POV-Ray", m.theirs, m.their_rays, m.their_shadow_tests);
  fmt::print("{:18} sundog is {:.2f} times as fast (frame), {:.2f} (whole); mean difference {:.4f}\n", "",
             m.frame_ratio(), m.whole_ratio(), m.difference);
}

// The default device, or a part of it that has as many compute units as POV-Ray gets threads.
std::vector<DeviceInfo> choose_device(unsigned threads) {
  const std::vector<DeviceInfo> all = enumerate_devices();
  std::vector<DeviceInfo> chosen = select_devices(all, {});
  const DeviceInfo& device = chosen.front();
  if (threads >= device.compute_units) return chosen;
  return select_devices(all, {fmt::format("{}:{}/{}", device.platform, device.device, threads)});
}

int run(const Options& options) {
  const std::string version = povray::installed_version();
  const std::vector<DeviceInfo> devices = choose_device(options.threads);
  fmt::print("{}, driver {}; {}; {} threads, {}x{}, {} runs in turn\n", devices.front().label(),
             devices.front().driver,
             version.empty() ? "POV-Ray is not installed (apt-get install povray)" : "POV-Ray " + version,
             options.threads, options.width, options.height, options.repeat);
  nlohmann::json report{
      {"device", devices.front().label()}, {"driver", devices.front().driver}, {"povray", version},
      {"threads", options.threads},        {"width", options.width},           {"height", options.height}};
  for (const std::string& scene : options.scenes) {
    const Measured m = measure(options, scene, devices, !version.empty());
    print(m, !version.empty());
    report["scenes"].push_back(to_json(m, !version.empty()));
  }
  if (!options.json.empty()) write_file(options.json, report.dump(2) + "\n");
  return 0;
}

}  // namespace
}  // namespace sundog

int main(int argc, char** argv) {
  sundog::Options options;
  CLI::App app{"Times whole frames of sundog and POV-Ray in turn"};
  app.add_option("SCENE", options.scenes, "scenes (default: hollow_ice and spheres)");
  app.add_option("--width", options.width)->check(CLI::PositiveNumber);
  app.add_option("--height", options.height)->check(CLI::PositiveNumber);
  app.add_option("--repeat", options.repeat, "runs of each")->check(CLI::PositiveNumber);
  app.add_option("--threads", options.threads, "of each (default: the machine's)")
      ->check(CLI::PositiveNumber);
  app.add_option("--json", options.json, "file for the figures");
  app.add_option("--folder", options.folder, "for POV-Ray's files");
  CLI11_PARSE(app, argc, argv);
  try {
    return sundog::run(options);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
