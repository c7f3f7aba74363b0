// Anti-aliasing and soft shadows against POV-Ray at equal error. Each program's pictures are compared with
// its own of many samples, so that models of light do not count; sundog's cheapest frame whose error is not
// greater than POV-Ray's is timed in turn with it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <thread>

#include "base/arguments.h"
#include "base/environment.h"
#include "base/error.h"
#include "base/file.h"
#include "base/image_compare.h"
#include "base/image_io.h"
#include "base/memory.h"
#include "bench_scenes.h"
#include "compile/compiled_scene.h"
#include "device/devices.h"
#include "parse_arguments.h"
#include "povray_from_scene.h"
#include "povray_run.h"
#include "render/session/render_session.h"
#include "scene/load.h"

namespace sundog {
namespace {

struct Options {
  std::vector<std::string> scenes;  // for anti-aliasing
  std::string shadow = SUNDOG_SOURCE_DIR "/bench/scenes/soft_shadow.json";
  int width = 320, height = 240, repeat = 5;
  std::vector<unsigned> threads;
  bool wall = false, one_frame = false;
  double alike = 0.02;
  std::string json, folder = "samples_against_povray";
};

/// One way of POV-Ray's to sample.
struct TheirWay {
  std::string name, sampling = povray::at_centres;
  povray::AreaGrid grid;
};

/// Ways of sundog's to sample, the cheapest first.
struct OurWays {
  std::string name;
  std::vector<std::vector<std::string>> overrides;
};

/// A scene and how both programs sample it.
struct Contest {
  std::string name, file;
  std::vector<TheirWay> theirs;
  std::vector<OurWays> ours;
  TheirWay their_reference;
  std::vector<std::string> our_reference;
};

using Scene = std::shared_ptr<const CompiledScene>;

/// One of sundog's frames with its error.
struct OurFrame {
  std::string name;
  Scene scene;
  double error = 0;
};

std::string set(const std::string& pointer, double value) { return fmt::format("{}={:g}", pointer, value); }

/// Thresholds of adaptive frames from coarse to fine, each with `common`.
OurWays adaptive(const std::vector<std::string>& common) {
  OurWays ways{"adaptive", {}};
  for (double threshold = 0.64; threshold > 5e-4; threshold /= std::pow(2.0, 0.25)) {
    ways.overrides.push_back(common);
    ways.overrides.back().push_back(set("/render/adaptive/threshold", threshold));
  }
  return ways;
}

/// Numbers of samples at `pointer`, each with `common`.
OurWays even(const std::string& pointer, const std::vector<std::string>& common) {
  OurWays ways{"even", {}};
  for (const int samples : {1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128}) {
    ways.overrides.push_back(common);
    ways.overrides.back().push_back(set(pointer, samples));
  }
  return ways;
}

Contest edges(const std::string& file) {
  const std::string no_threshold = "/render/adaptive/threshold=0";
  return {std::filesystem::path(file).stem().string(),
          file,
          {{"+A0.3", "+A0.3", {}}, {"+A0.3 +AM2", "+A0.3 +AM2", {}}},
          {adaptive({"/render/samples=256"}), even("/render/samples", {no_threshold})},
          {"reference", "+A0.0 -J +AM1 +R16", {}},
          {"/render/samples=256", no_threshold}};
}

/// Camera rays go through the pixels' centres in both programs, so that shadows alone are sampled.
Contest soft_shadow(const std::string& file) {
  const std::string samples = "/lights/1/samples";
  const std::vector<std::string> centre{"/render/filter_radius=0.001", "/render/samples=1024"};
  return {std::filesystem::path(file).stem().string(),
          file,
          {{"area_light 5x5 adaptive 1", povray::at_centres, {5, 1, true}},
           {"area_light 9x9 adaptive 1", povray::at_centres, {9, 1, true}},
           {"area_light 17x17 adaptive 1", povray::at_centres, {17, 1, true}}},
          {adaptive(centre), even(samples, {"/render/samples=1"})},
          {"reference", povray::at_centres, {65, -1, false}},
          {"/render/samples=1", samples + "=1024"}};
}

Image clamped(Image image) {
  for (float& value : image.data) value = std::clamp(value, 0.0f, 1.0f);  // POV-Ray's picture ends at 1
  return image;
}

SceneDescription load(const Options& options, const Contest& contest, std::vector<std::string> overrides) {
  overrides.push_back(set("/image/width", options.width));
  overrides.push_back(set("/image/height", options.height));
  SceneDescription scene = load_scene(contest.file, overrides);
  for (MaterialDescription& material : scene.materials)
    if (material.transmission != dvec3(0)) material.shadow_opaque = true;  // models of filtered light differ
  return scene;
}

povray::Run run_theirs(const Options& options, const Contest& contest, const TheirWay& way,
                       unsigned threads) {
  const std::string scene =
      povray::from_scene(load(options, contest, {}), povray::Absorption::fade, way.grid);
  return povray::run(scene, options.width, options.height, static_cast<int>(threads), options.folder,
                     contest.name + (way.name == "reference" ? "_reference" : ""), way.sampling);
}

Image our_picture(RenderSession& session, const Scene& scene) { return clamped(session.render(scene).image); }

/// The first frame of `ways` whose error is not greater than `error`; none: the finest is not good enough.
std::optional<OurFrame> cheapest(const Options& options, const Contest& contest, const OurWays& ways,
                                 RenderSession& session, const Image& right, double error) {
  for (const std::vector<std::string>& overrides : ways.overrides) {
    OurFrame frame{ways.name + " " + overrides.back().substr(overrides.back().rfind('/') + 1),
                   std::make_shared<const CompiledScene>(compile(load(options, contest, overrides))), 0};
    frame.error = compare_images(our_picture(session, frame.scene), right, 0).rms;
    if (frame.error <= error) return frame;
  }
  return std::nullopt;
}

DeviceInfo device_of(unsigned threads) {
  DeviceInfo device = select_devices(enumerate_devices(plain_environment()), {}).at(0);
  if (threads < device.compute_units) device.sub_units = threads;
  return device;
}

/// Seconds of a thread for a frame: of one, or the mean of as many in a row as take `seconds` together.
double time_frames(const Options& options, RenderSession& session, const Scene& scene, unsigned threads,
                   double seconds) {
  double sum = 0;
  int frames = 0;
  do {
    sum += elapsed([&] { session.render(scene); }).of_thread(threads, options.wall);
    ++frames;
  } while (!options.one_frame && sum < seconds);
  return sum / frames;
}

/// Times frames of ours in turn with one way of theirs.
nlohmann::json time_both(const Options& options, const Contest& contest, const TheirWay& their_way,
                         const OurFrame& frame, unsigned threads, double their_error) {
  RenderSession session({device_of(threads)});
  session.render(frame.scene);
  std::vector<double> ours, theirs, ratios;
  for (int i = 0; i < options.repeat; ++i) {
    const povray::Run run = run_theirs(options, contest, their_way, threads);
    theirs.push_back(options.wall ? run.seconds : run.cpu_seconds / threads);
    ours.push_back(time_frames(options, session, frame.scene, threads, theirs.back()));
    ratios.push_back(theirs.back() / ours.back());
  }
  const Spread ratio = spread(ratios);
  fmt::print("{:14} {:28}{:9.5f}{:8.3f}   {:28}{:9.5f}{:8.4f}{:3}{:8.2f} ({:.2f}..{:.2f})\n", contest.name,
             their_way.name, their_error, spread(theirs).median, frame.name, frame.error, spread(ours).median,
             threads, ratio.median, ratio.min, ratio.max);
  std::fflush(stdout);
  return {{"scene", contest.name},
          {"threads", threads},
          {"povray", their_way.name},
          {"povray_error", their_error},
          {"povray_seconds", to_json(spread(theirs))},
          {"sundog", frame.name},
          {"sundog_error", frame.error},
          {"sundog_seconds", to_json(spread(ours))},
          {"ratio", to_json(ratio)}};
}

nlohmann::json measure(const Options& options, const Contest& contest) {
  const unsigned all = options.threads.back();
  const Image their_right = run_theirs(options, contest, contest.their_reference, all).image;
  RenderSession session({device_of(all)});
  const Image our_right = our_picture(
      session, std::make_shared<const CompiledScene>(compile(load(options, contest, contest.our_reference))));
  write_image(our_right, std::filesystem::path(options.folder) / (contest.name + "_sundog.png"));
  const double apart = compare_images(our_right, their_right, 0).mean;
  if (apart > options.alike)
    throw std::runtime_error(fmt::format(
        "{}: the reference pictures in {} differ by {:.4f} in the mean, more than {}: no time counts",
        contest.name, options.folder, apart, options.alike));
  nlohmann::json out = nlohmann::json::array();
  for (const TheirWay& their_way : contest.theirs) {
    const double error =
        compare_images(run_theirs(options, contest, their_way, all).image, their_right, 0).rms;
    for (const OurWays& ways : contest.ours) {
      const auto frame = cheapest(options, contest, ways, session, our_right, error);
      if (!frame) {
        fmt::print("{:14} {:28}{:9.5f}  {}: no frame is as good\n", contest.name, their_way.name, error,
                   ways.name);
        continue;
      }
      for (const unsigned threads : options.threads)
        out.push_back(time_both(options, contest, their_way, *frame, threads, error));
    }
  }
  return out;
}

int run(Options options) {
  if (options.threads.empty()) {
    options.threads = {1};
    const unsigned all = std::thread::hardware_concurrency();
    if (all > 1) options.threads.push_back(all);
  }
  if (options.scenes.empty())
    options.scenes = {SUNDOG_SOURCE_DIR "/scenes/antialiasing.json", SUNDOG_SOURCE_DIR "/scenes/spheres.json",
                      SUNDOG_SOURCE_DIR "/bench/scenes/ice_boxes.json"};
  const std::string version = povray::installed_version();
  if (version.empty()) throw DeviceError("POV-Ray is not installed (apt-get install povray)");
  const DeviceInfo device = device_of(options.threads.back());
  fmt::print(
      "{}, driver {}; POV-Ray {}\n{}x{}, {} runs in turn; seconds of a thread by the {} clock; of sundog "
      "{}\n",
      device.label(), device.driver, version, options.width, options.height, options.repeat,
      options.wall ? "wall" : "processor's",
      options.one_frame ? "one frame" : "the mean of frames in a row that take as long as POV-Ray's run");
  fmt::print("{:14} {:28}{:>9}{:>8}   {:28}{:>9}{:>8}{:>3}{:>8}\n", "", "POV-Ray", "rms", "s", "sundog",
             "rms", "s", "on", "ratio");
  nlohmann::json report{{"device", device.label()},
                        {"driver", device.driver},
                        {"povray", version},
                        {"width", options.width},
                        {"height", options.height},
                        {"clock", options.wall ? "wall" : "processor"},
                        {"one_frame", options.one_frame}};
  for (const std::string& file : options.scenes) report["edges"].push_back(measure(options, edges(file)));
  if (!options.shadow.empty()) report["soft_shadow"] = measure(options, soft_shadow(options.shadow));
  if (!options.json.empty()) write_file(options.json, report.dump(2) + "\n");
  return 0;
}

}  // namespace
}  // namespace sundog

int main(int argc, char** argv) {
  sundog::Options options;
  sundog::Arguments app{"Times anti-aliasing and soft shadows of sundog and POV-Ray in turn, at equal error"};
  app.add_option("SCENE", options.scenes,
                 "scene files for anti-aliasing (default: antialiasing, spheres, ice_boxes)");
  app.add_option("--shadow", options.shadow,
                 "scene whose second light is a rectangle (default: bench/scenes/soft_shadow.json)");
  app.add_option("--width", options.width, "pixels (default 320)")->positive();
  app.add_option("--height", options.height, "pixels (default 240)")->positive();
  app.add_option("--repeat", options.repeat, "runs of each (default 5)")->positive();
  app.add_option("--threads", options.threads, "of each; repeatable (default: 1 and the machine's)");
  app.add_option("--alike", options.alike, "mean difference of the references up to which times count");
  app.add_option("--json", options.json, "file for the figures");
  app.add_option("--folder", options.folder, "for the pictures and POV-Ray's files");
  app.add_flag(
      "--one-frame", options.one_frame,
      "time a single frame of sundog's; without it the mean of as many as take as long as POV-Ray's run");
  app.add_flag("--wall", options.wall, "wall clock; without it processor time over threads");
  parse_or_exit(app, argc, argv);
  sundog::keep_freed_memory();  // as the command line does
  try {
    return sundog::run(options);
  } catch (const std::exception& error) {
    fmt::print(stderr, "samples_against_povray: {}\n", error.what());
    return 1;
  }
}
