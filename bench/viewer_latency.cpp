// How long a session (render/session) takes from an edit to the first picture of the whole frame, coarse or
// not, to one with a sample of each pixel, and to the settled one; of a camera's, a material's, a light's and
// a field parameter's edits. Prints medians and 95th percentiles in milliseconds.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

#include "base/arguments.h"
#include "base/environment.h"
#include "base/error.h"
#include "base/file.h"
#include "device/devices.h"
#include "parse_arguments.h"
#include "render/device/tuning.h"
#include "render/session/render_session.h"
#include "scene/load.h"

using namespace sundog;

namespace {

struct Options {
  std::vector<std::string> scenes{"mandelbulb", "spheres", "hollow_ice"}, devices{"cpu"};
  int size = 640, repeats = 20, samples = 1;
  std::string json;
};

/// One kind of edit: what it does the i-th time; false: the scene has nothing for it.
struct Edit {
  const char* name;
  std::function<bool(SceneDescription&, int)> apply;
};

std::vector<Edit> edits() {
  return {{"camera",
           [](SceneDescription& scene, int i) {
             const dvec3 arm = scene.camera.position - scene.camera.target;
             const double angle = 0.02 * (i % 2 ? 1 : 2);
             scene.camera.position =
                 scene.camera.target + dvec3(std::cos(angle) * arm.x + std::sin(angle) * arm.z, arm.y,
                                             std::cos(angle) * arm.z - std::sin(angle) * arm.x);
             return true;
           }},
          {"material",
           [](SceneDescription& scene, int i) {
             if (scene.materials.empty()) return false;
             scene.materials[0].diffuse = dvec3(0.3 + 0.01 * i);
             return true;
           }},
          {"light",
           [](SceneDescription& scene, int i) {
             if (scene.lights.empty()) return false;
             scene.lights.back().intensity = 1 + 0.02 * i;
             return true;
           }},
          {"parameter", [](SceneDescription& scene, int i) {
             if (scene.fields.empty() || scene.fields[0].root.formula.steps.empty()) return false;
             std::vector<double>& values = scene.fields[0].root.formula.steps[0].values;
             if (values.empty()) return false;
             values[0] += i % 2 ? 0.01 : -0.01;
             return true;
           }}};
}

double quantile(std::vector<double> values, double share) {
  std::ranges::sort(values);
  const auto at = static_cast<std::size_t>(std::lround(share * static_cast<double>(values.size() - 1)));
  return values[at];
}

struct Times {
  std::vector<double> compiled, first, full, settled;
};

void add_run(RenderSession& session, const SceneDescription& scene, Times& times) {
  session.start(std::make_shared<const SceneDescription>(scene));
  session.wait();
  const Snapshot end = session.snapshot(false);
  if (end.state != SessionState::settled) throw DeviceError(end.error);
  times.compiled.push_back(1e3 * end.times.compiled);
  times.first.push_back(1e3 * end.times.first);
  times.full.push_back(1e3 * end.times.full);
  times.settled.push_back(1e3 * end.times.settled);
}

nlohmann::json figures(const std::string& scene, const char* edit, const Times& times) {
  nlohmann::json row{{"scene", scene}, {"edit", edit}};
  fmt::print("{:12} {:10}", scene, edit);
  const auto add = [&](const char* name, const std::vector<double>& values) {
    row[name] = {{"median_ms", quantile(values, 0.5)}, {"p95_ms", quantile(values, 0.95)}};
    fmt::print("  {:8.1f} {:8.1f}", quantile(values, 0.5), quantile(values, 0.95));
  };
  add("compiled", times.compiled);
  add("first", times.first);
  add("full", times.full);
  add("settled", times.settled);
  fmt::print("\n");
  std::fflush(stdout);
  return row;
}

nlohmann::json measure(const Options& options) {
  const std::vector<DeviceInfo> devices =
      select_devices(enumerate_devices(plain_environment()), options.devices);
  RenderSession session(devices);
  nlohmann::json rows = nlohmann::json::array();
  fmt::print("{}, {} x {}, {} samples, {} edits of a kind; ms: median, 95th percentile\n", devices[0].label(),
             options.size, options.size, options.samples, options.repeats);
  fmt::print("{:12} {:10}  {:>17}  {:>17}  {:>17}  {:>17}\n", "scene", "edit", "compiled", "first", "full",
             "settled");
  for (const std::string& name : options.scenes) {
    SceneDescription scene = load_scene(
        name.ends_with(".json") ? name : fmt::format("{}/scenes/{}.json", SUNDOG_SOURCE_DIR, name));
    scene.image.width = scene.image.height = options.size;
    scene.render.samples = options.samples;
    Times start;
    add_run(session, scene, start);
    rows.push_back(figures(name, "(start)", start));
    for (const Edit& edit : edits()) {
      Times times;
      for (int i = 0; i < options.repeats && edit.apply(scene, i); ++i) add_run(session, scene, times);
      if (!times.first.empty()) rows.push_back(figures(name, edit.name, times));
    }
  }
  return rows;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  Arguments app("How long a session takes from an edit to its pictures");
  app.add_option("scenes", options.scenes, "shipped scenes, or files");
  app.add_option("--device", options.devices, "devices as sundog names them")->one_value_each();
  app.add_option("--size", options.size, "pixels a side")->range(16, 4096);
  app.add_option("--samples", options.samples, "of a pixel")->range(1, 65536);
  app.add_option("--repeats", options.repeats, "edits of each kind")->range(1, 10000);
  app.add_option("--json", options.json, "file for the figures");
  parse_or_exit(app, argc, argv);
  try {
    const nlohmann::json rows = measure(options);
    if (!options.json.empty()) write_file(options.json, rows.dump(2) + "\n");
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "viewer_latency: {}\n", error.what());
    return 1;
  }
}
