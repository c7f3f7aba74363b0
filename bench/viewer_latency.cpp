// How long the viewer takes from a change of its document to the first picture of the whole frame, coarse or
// not, to one with a sample of each pixel, and to the settled one; of a camera's, a material's, a light's, a
// parameter's and a formula's edits, the first after the session has rested. The document is read as `sundog
// serve` reads it, and a session (render/session) draws it. Prints medians and 95th percentiles in
// milliseconds, and what the pictures cost that are sent.
#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <thread>

#include "base/arguments.h"
#include "base/clock.h"
#include "base/environment.h"
#include "base/error.h"
#include "base/file.h"
#include "base/image_io.h"
#include "base/pixels/preview.h"
#include "base/pixels/quick_png.h"
#include "device/devices.h"
#include "parse_arguments.h"
#include "render/device/tuning.h"
#include "render/session/render_session.h"
#include "scene/document.h"

using namespace sundog;
using nlohmann::json;

namespace {

struct Options {
  std::vector<std::string> scenes{"mandelbulb", "spheres", "hollow_ice"}, devices{"cpu"};
  int size = 640, repeats = 20, samples = 1;
  std::string json;
};

/// One kind of edit: what it does the i-th time; false: the scene has nothing for it.
struct Edit {
  const char* name;
  std::function<bool(json&, int)> apply;
  int most = 10000;  // repeats
};

dvec3 vec3_of(const json& list) { return {list[0], list[1], list[2]}; }

bool turn_camera(json& scene, int i) {
  json& camera = scene["camera"];
  const dvec3 target = vec3_of(camera["target"]), arm = vec3_of(camera["position"]) - target;
  const double angle = 0.02 * (i % 2 ? 1 : 2);
  camera["position"] = {target.x + std::cos(angle) * arm.x + std::sin(angle) * arm.z, target.y + arm.y,
                        target.z + std::cos(angle) * arm.z - std::sin(angle) * arm.x};
  return true;
}

bool change_color(json& scene, int i) {
  for (json& material : scene["materials"])
    if (material.contains("color") && material["color"].is_array()) {
      material["color"] = {0.3 + 0.01 * i, 0.4, 0.5};
      return true;
    }
  return false;
}

bool change_light(json& scene, int i) {
  scene["lights"].back()["intensity"] = 1 + 0.02 * i;
  return true;
}

/// An object that is a field by itself.
json* field_of(json& scene) {
  for (json& object : scene["objects"])
    if (object["type"] == "fractal" || object["type"] == "formula") return &object;
  return nullptr;
}

/// Of a fractal how far it goes, which is a parameter that all have.
bool change_parameter(json& scene, int i) {
  json* field = field_of(scene);
  if (field) (*field)["iterations"] = 12 + i % 4;
  return field;
}

/// Another text each time, in this run and the one before: its kernel is in no cache.
bool change_formula(json& scene, int i) {
  json* field = field_of(scene);
  if (!field) return false;
  const auto now = std::chrono::steady_clock::now().time_since_epoch().count() % 1000000;
  *field = {{"type", "formula"},
            {"material", (*field)["material"]},
            {"parameters", {{"size", 1}}},
            {"distance", fmt::format("length(p) - size + 0.1 * sin({}.{:06} * p.x)", i + 3, now)}};
  return true;
}

std::vector<Edit> edits() {
  return {{"camera", turn_camera},
          {"material", change_color},
          {"light", change_light},
          {"parameter", change_parameter},
          {"formula", change_formula, 5}};
}

double quantile(std::vector<double> values, double share) {
  std::ranges::sort(values);
  const auto at = static_cast<std::size_t>(std::lround(share * static_cast<double>(values.size() - 1)));
  return values[at];
}

struct Times {
  std::vector<double> read, compiled, first, full, settled;
};

/// A document and its scene, as the viewer has them.
struct Shown {
  json document;
  std::filesystem::path file;
  std::shared_ptr<const SceneDescription> scene;
};

/// From the change of the document until the picture is settled.
void time_edit(RenderSession& session, Shown& shown, json after, Times& times) {
  const Stopwatch clock;
  auto scene = shown.scene ? change_scene(*shown.scene, shown.document, after) : nullptr;
  if (!scene) scene = std::make_shared<const SceneDescription>(load_scene_document(after, shown.file));
  const double read = clock.seconds();
  session.start(scene);
  session.wait();
  const Snapshot end = session.snapshot(false);
  if (end.state != SessionState::settled) throw DeviceError(end.error);
  const auto add = [&](std::vector<double>& list, double seconds) { list.push_back(1e3 * seconds); };
  add(times.read, read);
  add(times.compiled, read + end.times.compiled);
  add(times.first, read + end.times.first);
  add(times.full, read + end.times.full);
  add(times.settled, read + end.times.settled);
  shown.document = std::move(after);
  shown.scene = std::move(scene);
}

/// As long as somebody looks at the picture: until the kernels for edits to come are built.
void rest(const RenderSession& session) {
  const Stopwatch clock;
  while (!session.snapshot(false).prepared && clock.seconds() < 120)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
}

/// Processor seconds of this thread: what else runs beside it does not count.
double thread_seconds() {
  timespec now{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// What a picture costs on its way to the page: a JPEG while it changes, a PNG when it rests, and for
/// comparison the PNG for files.
json time_pictures(const Image& image) {
  Image opaque(image.width, image.height, 3);
  for (std::size_t i = 0; i < opaque.data.size(); ++i) opaque.data[i] = image.data[i / 3 * 4 + i % 3];
  json row;
  fmt::print("  pictures of {} x {}:", image.width, image.height);
  const auto add = [&](const char* name, const std::function<std::string()>& encode) {
    std::vector<double> times;
    std::size_t bytes = 0;
    for (int i = 0; i < 7; ++i) {
      const double begun = thread_seconds();
      bytes = encode().size();
      times.push_back(1e3 * (thread_seconds() - begun));
    }
    const double ms = quantile(times, 0.5), speed = 3e-3 * static_cast<double>(image.data.size()) / 4 / ms;
    row[name] = {{"median_ms", ms}, {"bytes", bytes}, {"megabytes_a_second", speed}};
    fmt::print("  {} {:.1f} ms of a core ({:.0f} MB/s, {} KB)", name, ms, speed, bytes / 1000);
  };
  add("JPEG", [&] { return encode_preview(image, 90); });
  add("PNG", [&] { return encode_quick_png(image); });
  add("PNG of files", [&] { return encode_image(opaque, "picture.png"); });
  fmt::print("\n");
  return row;
}

json figures(const std::string& scene, const char* edit, const Times& times) {
  json row{{"scene", scene}, {"edit", edit}};
  fmt::print("{:12} {:10}", scene, edit);
  const auto add = [&](const char* name, const std::vector<double>& values) {
    row[name] = {{"median_ms", quantile(values, 0.5)}, {"p95_ms", quantile(values, 0.95)}};
    fmt::print("  {:8.1f} {:8.1f}", quantile(values, 0.5), quantile(values, 0.95));
  };
  add("read", times.read);
  add("compiled", times.compiled);
  add("first", times.first);
  add("full", times.full);
  add("settled", times.settled);
  fmt::print("\n");
  std::fflush(stdout);
  return row;
}

json measure(const Options& options) {
  const std::vector<DeviceInfo> devices =
      select_devices(enumerate_devices(plain_environment()), options.devices);
  RenderSession session(devices);
  json rows = json::array();
  fmt::print("{}, {} x {}, {} samples, {} edits of a kind; ms: median, 95th percentile\n", devices[0].label(),
             options.size, options.size, options.samples, options.repeats);
  fmt::print("{:12} {:10}  {:>17}  {:>17}  {:>17}  {:>17}  {:>17}\n", "scene", "edit", "read", "compiled",
             "first", "full", "settled");
  for (const std::string& name : options.scenes) {
    Shown shown;
    shown.file = name.ends_with(".json") ? name : fmt::format("{}/scenes/{}.json", SUNDOG_SOURCE_DIR, name);
    json document = read_scene_document(shown.file);
    document["image"]["width"] = document["image"]["height"] = options.size;
    document["render"]["samples"] = options.samples;
    Times start;
    time_edit(session, shown, document, start);
    rows.push_back(figures(name, "(start)", start));
    rest(session);
    rows.back()["pictures"] = time_pictures(*session.snapshot().picture);
    for (const Edit& edit : edits()) {
      Times times;
      for (int i = 0; i < std::min(options.repeats, edit.most) && edit.apply(document, i); ++i)
        time_edit(session, shown, document, times);
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
    const json rows = measure(options);
    if (!options.json.empty()) write_file(options.json, rows.dump(2) + "\n");
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "viewer_latency: {}\n", error.what());
    return 1;
  }
}
