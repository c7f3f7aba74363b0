// Renders the contact sheet of docs: every surface of `sundog formulas` with its default parameters in one
// picture, each above its name. docs/render_pictures.sh runs it.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <numbers>
#include <vector>

#include "base/arguments.h"
#include "base/environment.h"
#include "base/image_io.h"
#include "bench/frames/frame_runner.h"
#include "compile/compiled_scene.h"
#include "device/devices.h"
#include "formula/list.h"
#include "peer_program.h"
#include "scene/read/scene_reader.h"
#include "stb/stb_easy_font.h"

using namespace sundog;
using nlohmann::json;

namespace {

struct Sheet {
  std::string out, device = "cpu";
  int size = 200, columns = 8, samples = 9;
  bool names = true;
};

constexpr int label_height = 22;
constexpr double label_scale = 1.5;  // image pixels for one of the font's
const float dark = linear_from_srgb(0.11f), light = linear_from_srgb(0.88f);

/// The camera's target and angle; its position is fixed.
struct View {
  std::array<double, 3> target{};
  double tangent = 0.43;  // of half the angle
};

/// A surface and the camera's position: above, at one corner of its bounds.
struct Subject {
  const FormulaDefinition& formula;
  std::array<double, 3> center{}, camera{};
  double radius = 0, away = 0;
};

constexpr double right[] = {0.834, 0, -0.551},
                 up[] = {-0.232, 0.907, -0.351};  // of the camera, which looks along (-0.5, -0.42, -0.757)

Subject subject_of(const FormulaDefinition& d) {
  const auto& b = d.bounds;
  Subject s{d, {(b[0] + b[3]) / 2, (b[1] + b[4]) / 2, (b[2] + b[5]) / 2}, {}, 0, 0};
  s.radius = std::hypot(b[3] - b[0], b[4] - b[1], b[5] - b[2]) / 2;
  s.away = 2.5 * s.radius;
  s.camera = {s.center[0] + 0.5 * s.away, s.center[1] + 0.42 * s.away, s.center[2] + 0.757 * s.away};
  return s;
}

json scene_of(const Subject& subject, const View& view, int size, int samples) {
  json object = {{"type", "fractal"},
                 {"formula", subject.formula.name},
                 {"material", "coat"},
                 {"occlusion", 0.1 * subject.radius}};
  if (subject.formula.kind != FormulaKind::direct)
    object["coloring"] = {
        {"by", "point"},
        {"palette", {{0.8, 0.42, 0.16}, {0.85, 0.75, 0.5}, {0.25, 0.42, 0.6}, {0.6, 0.3, 0.25}}}};
  return {
      {"camera",
       {{"position", subject.camera},
        {"target", view.target},
        {"fov", 2 * std::atan(view.tangent) * 180 / std::numbers::pi}}},
      {"image", {{"width", size}, {"height", size}, {"background", {dark, dark, dark}}}},
      {"render", {{"samples", samples}}},
      {"lights",
       {{{"type", "ambient"}, {"intensity", 1.8}},
        {{"type", "directional"}, {"direction", {-0.2, -0.9, -0.6}}, {"intensity", 1.05}}}},
      {"materials",
       {{"coat", {{"color", {0.75, 0.7, 0.6}}, {"specular", {{"coefficient", 0.25}, {"exponent", 40}}}}}}},
      {"objects", {object}}};
}

Image render(const json& scene, const DeviceInfo& device) {
  const JsonContext context{"formula_sheet"};
  const CompiledScene compiled = compile(read_scene(JsonValue(scene, context)));
  FrameRunner frames(device, compiled);
  frames.run();
  return frames.image();
}

/// A view in which the surface nearly fills the picture. `probe`: a picture of the whole bounds.
View fitted(const Subject& subject, const View& wide, const Image& probe) {
  int low[] = {probe.width, probe.height}, high[] = {0, 0};
  for (int y = 0; y < probe.height; ++y)
    for (int x = 0; x < probe.width; ++x)
      if (probe.pixel(x, y)[0] != probe.pixel(0, 0)[0] || probe.pixel(x, y)[2] != probe.pixel(0, 0)[2]) {
        low[0] = std::min(low[0], x), high[0] = std::max(high[0], x + 1);
        low[1] = std::min(low[1], y), high[1] = std::max(high[1], y + 1);
      }
  if (low[0] >= high[0]) return wide;
  const double pixel = 2 * wide.tangent / probe.width;  // at a distance of 1
  const double x = ((low[0] + high[0]) / 2.0 - probe.width / 2.0) * pixel * subject.away;
  const double y = (probe.height / 2.0 - (low[1] + high[1]) / 2.0) * pixel * subject.away;
  View view = wide;
  for (std::size_t i = 0; i < 3; ++i) view.target[i] += x * right[i] + y * up[i];
  view.tangent = 0.56 * std::max(high[0] - low[0], high[1] - low[1]) * pixel;
  return view;
}

Image picture_of(const FormulaDefinition& d, const Sheet& sheet, const DeviceInfo& device) {
  const Subject subject = subject_of(d);
  const View wide{subject.center};
  const View view = fitted(subject, wide, render(scene_of(subject, wide, 64, 1), device));
  return render(scene_of(subject, view, sheet.size, sheet.samples), device);
}

void copy_into(Image& sheet, const Image& tile, int left, int top) {
  for (int y = 0; y < tile.height; ++y)
    for (int x = 0; x < tile.width; ++x)
      for (int c = 0; c < 3; ++c) sheet.pixel(left + x, top + y)[c] = tile.pixel(x, y)[c];
}

/// A corner of one of the font's rectangles, in stb_easy_font's 16 bytes.
struct Corner {
  float x, y, z;
  unsigned char color[4];
};

/// How much of [at, at + 1] lies in [low, high].
float overlap(int at, double low, double high) {
  return static_cast<float>(std::max(0.0, std::min(high, at + 1.0) - std::max(low, static_cast<double>(at))));
}

/// Writes `text` centred in `width` pixels from `left` on.
void write_label(Image& sheet, std::string text, int left, int top, int width) {
  std::vector<Corner> corners(std::size_t{4} * 32 * text.size());
  const int quads = stb_easy_font_print(0, 0, text.data(), nullptr, corners.data(),
                                        static_cast<int>(corners.size() * sizeof(Corner)));
  const double start = left + (width - label_scale * stb_easy_font_width(text.data())) / 2, line = top + 4;
  for (int q = 0; q < quads; ++q) {
    const Corner &a = corners[static_cast<std::size_t>(4 * q)],
                 &b = corners[static_cast<std::size_t>(4 * q + 2)];
    const double x0 = start + label_scale * static_cast<double>(a.x),
                 x1 = start + label_scale * static_cast<double>(b.x);
    const double y0 = line + label_scale * static_cast<double>(a.y),
                 y1 = line + label_scale * static_cast<double>(b.y);
    for (int y = std::max(0, static_cast<int>(y0)); y < std::min(sheet.height, static_cast<int>(y1) + 1); ++y)
      for (int x = std::max(left, static_cast<int>(x0)); x < std::min(left + width, static_cast<int>(x1) + 1);
           ++x)
        for (int c = 0; c < 3; ++c)
          sheet.pixel(x, y)[c] += (light - dark) * overlap(x, x0, x1) * overlap(y, y0, y1);
  }
}

void make(const Sheet& sheet) {
  const DeviceInfo device = select_devices(enumerate_devices(plain_environment()), {sheet.device}).at(0);
  const int count = static_cast<int>(formula_list().size()),
            rows = (count + sheet.columns - 1) / sheet.columns;
  const int row_height = sheet.size + (sheet.names ? label_height : 0);
  Image all(sheet.columns * sheet.size, rows * row_height, 3);
  std::fill(all.data.begin(), all.data.end(), dark);
  for (int i = 0; i < count; ++i) {
    const FormulaDefinition& d = formula_list()[static_cast<std::size_t>(i)];
    const int left = i % sheet.columns * sheet.size, top = i / sheet.columns * row_height;
    copy_into(all, picture_of(d, sheet, device), left, top);
    if (sheet.names) write_label(all, d.name, left, top + sheet.size, sheet.size);
    fmt::print("{} of {}: {}\n", i + 1, count, d.name);
    std::fflush(stdout);
  }
  write_image(all, sheet.out);
}

}  // namespace

int main(int argc, char** argv) {
  Sheet sheet;
  Arguments app("One picture of every surface of the list");
  app.add_option("-o,--out", sheet.out, "image file")->required();
  app.add_option("--device", sheet.device, "SPEC of sundog's (default cpu)");
  app.add_option("--size", sheet.size, "pixels a side of each surface (default 200)")->range(64, 2048);
  app.add_option("--columns", sheet.columns, "surfaces in a row (default 8)")->range(1, 32);
  app.add_option("--samples", sheet.samples, "samples a pixel (default 9)")->range(1, 4096);
  bool bare = false;
  app.add_flag("--no-names", bare, "the surfaces alone, without their names");
  return run_program(app, argc, argv, [&] {
    sheet.names = !bare;
    make(sheet);
  });
}
