// Times whole runs of sundog and Mandelbulber 2 on the processor, from command to PNG, in turn and each on
// one thread, with the same surfaces, cameras and thresholds (one pixel). Both render one light with its
// shadow but shade differently, so only outlines are compared. Mandelbulber's Mandelbulb measures its angle
// from the equator, which gives a different set of the same kind, whose outlines differ.
#include <fmt/format.h>
#include <sys/resource.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/arguments.h"
#include "base/file.h"
#include "base/image_io.h"
#include "peer_program.h"

using namespace sundog;

namespace {

struct Options {
  int size = 640, repeats = 3;
  std::string device = "cpu/1", folder = "against_mandelbulber", json;
};

struct Surface {
  const char *name, *camera;    // the camera's position; it looks at the origin
  const char *fields, *theirs;  // keys of the object in our scene; lines of Mandelbulber's settings
  const char* main = "";        // more of Mandelbulber's main parameters
};

const Surface surfaces[] = {
    {"mandelbulb", "1.2, -2.2, 1.0", R"("formula": "mandelbulb")", "power 8;", "formula_1 2;"},
    {"menger", "1.9, -2.9, 1.7", R"("formula": "menger", "iterations": 12)", "", "formula_1 7;"},
    {"mandelbox", "3.6, -6.6, 3.2",
     R"("formula": "mandelbox", "parameters": {"scale": -1.5}, "iterations": 250)", "mandelbox_scale -1.5;",
     "formula_1 8;"},
    {"julia", "1.0, -2.4, 1.0",
     R"("formula": "julia", "parameters": {"seed": [-0.2, 0.6, 0.2, 0]}, "iterations": 250)", "",
     "formula_1 5;\njulia_mode true;\njulia_c -0.2 0.6 0.2;"},
};

std::string our_scene(const Surface& s, int size) {
  return fmt::format(R"({{
  "camera": {{"position": [{}], "target": [0, 0, 0], "up": [0, 0, 1], "fov": 53.130102}},
  "image": {{"width": {}, "height": {}, "background": [1, 0, 1]}},
  "lights": [{{"type": "ambient", "intensity": 0.3}}, {{"type": "directional", "direction": [-0.3, 0.8, -0.8]}}],
  "materials": {{"coat": {{"color": [0.8, 0.7, 0.5], "specular": {{"coefficient": 0.5, "exponent": 30}}}}}},
  "objects": [{{"type": "fractal", {}, "material": "coat", "detail": 1}}]
}})",
                     s.camera, size, size, s.fields);
}

std::string their_settings(const Surface& s, int size) {
  std::string camera = s.camera;
  std::erase(camera, ',');
  std::string colors;
  for (int i = 1; i <= 3; i++) colors += fmt::format("background_color_{} ffff 0000 ffff;\n", i);
  return fmt::format(
      "# Mandelbulber settings file\n# version 2.20\n# only modified parameters\n[main_parameters]\ncamera "
      "{};\n"
      "target 0 0 0;\ncamera_top 0 0 1;\nimage_height {};\nimage_width {};\n{}{}\n[fractal_1]\n{}\n",
      camera, size, size, colors, s.main, s.theirs);
}

struct Times {
  std::vector<double> wall, processor;  // seconds
};

/// Runs a program on one processor with its output in `log` and appends its times. Throws if it fails.
void run(const std::string& command, const std::string& log, Times& times) {
  const auto processor = [] {
    rusage used{};
    ::getrusage(RUSAGE_CHILDREN, &used);
    const auto seconds = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
    return seconds(used.ru_utime) + seconds(used.ru_stime);
  };
  const double before = processor();
  const Stopwatch clock;
  if (std::system(fmt::format("taskset -c 0 {} > '{}' 2>&1", command, log).c_str()) != 0)
    throw std::runtime_error(fmt::format("{}: it failed; see {}", command, log));
  times.wall.push_back(clock.seconds());
  times.processor.push_back(processor() - before);
}

/// The share of pixels that show the magenta background in only one of the pictures.
double outline_difference(const std::string& a, const std::string& b) {
  const Image ours = read_image(a), theirs = read_image(b);
  const auto is_empty = [](const float* c) { return c[0] > 0.95f && c[1] < 0.01f && c[2] > 0.95f; };
  int different = 0;
  for (int y = 0; y < ours.height; y++)
    for (int x = 0; x < ours.width; x++)
      different += is_empty(ours.pixel(x, y)) != is_empty(theirs.pixel(x, y));
  return static_cast<double>(different) / (static_cast<double>(ours.width) * ours.height);
}

nlohmann::json measure(const Surface& s, const Options& options) {
  const std::filesystem::path base = std::filesystem::path(options.folder) / s.name;
  const auto file = [&](const char* end) { return base.string() + end; };
  write_file(file(".json"), our_scene(s, options.size));
  write_file(file(".fract"), their_settings(s, options.size));
  const std::string ours = fmt::format("'{}' render '{}' -o '{}' --device '{}' --quiet", SUNDOG_BINARY,
                                       file(".json"), file("_sundog.png"), options.device);
  const std::string theirs = fmt::format("mandelbulber2 -n -C -f png -r {0}x{0} -o '{1}' '{2}'", options.size,
                                         file("_mandelbulber.png"), file(".fract"));
  Times warm_up, our_times, their_times;
  run(ours, file("_sundog.log"), warm_up);  // builds the kernels into the cache
  for (int i = 0; i < options.repeats; i++) {
    run(ours, file("_sundog.log"), our_times);
    run(theirs, file("_mandelbulber.log"), their_times);
  }
  const Spread wall = ratio(their_times.wall, our_times.wall),
               processor = ratio(their_times.processor, our_times.processor);
  const double outlines = outline_difference(file("_sundog.png"), file("_mandelbulber.png"));
  fmt::print("{:12} {:8.2f} s {:8.2f} s {:9.1f} {:9.1f} {:9.2f} %\n", s.name, spread(our_times.wall).median,
             spread(their_times.wall).median, wall.median, processor.median, 100 * outlines);
  return {{"surface", s.name},
          {"sundog_seconds", our_times.wall},
          {"mandelbulber_seconds", their_times.wall},
          {"sundog_processor_seconds", our_times.processor},
          {"mandelbulber_processor_seconds", their_times.processor},
          {"ratio", wall.median},
          {"processor_ratio", processor.median},
          {"outlines_differ", outlines}};
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  Arguments app("Whole runs of sundog and of Mandelbulber 2 in turn, each on one thread of the processor.");
  app.add_option("--size", options.size, "pixels a side")->range(16, 4096);
  app.add_option("--repeats", options.repeats)->range(1, 100);
  app.add_option("--device", options.device, "sundog's OpenCL device");
  app.add_option("--folder", options.folder, "for scenes and pictures");
  app.add_option("--json", options.json, "file for the figures");
  setenv("QT_QPA_PLATFORM", "offscreen", 0);
  return run_program(app, argc, argv, [&] {
    std::filesystem::create_directories(options.folder);
    fmt::print("{0}x{0}, one thread, {1} runs in turn\n{2:12} {3:>10} {4:>10} {5:>9} {6:>9} {7:>11}\n",
               options.size, options.repeats, "", "sundog", "Mandelb.", "x wall", "x cpu", "outlines");
    nlohmann::json report{{"size", options.size}, {"repeats", options.repeats}};
    for (const Surface& s : surfaces) report["surfaces"].push_back(measure(s, options));
    if (!options.json.empty()) write_file(options.json, report.dump(2) + "\n");
  });
}
