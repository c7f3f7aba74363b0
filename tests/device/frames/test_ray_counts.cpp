// The AOV of rays: for every pixel those of its samples, in plain frames and in passes; together those of the
// statistics. The pixels of rays that leave what they had not entered.
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <nlohmann/json.hpp>
#include <numeric>

#include "catch.h"
#include "devices.h"
#include "render/film/part.h"
#include "same_bits.h"
#include "scene/json/parse.h"
#include "scene/load.h"
#include "scene/read/scene_reader.h"
#include "scenes.h"
#include "temporary_folder.h"

using namespace sundog;

namespace {

/// Mirrors, glass, fields and shadows.
SceneDescription things(const char* integrator, bool adaptive) {
  SceneDescription scene = load_scene(SUNDOG_SOURCE_DIR "/tests/support/moving_things.json");
  for (Object& object : scene.objects) object.moves_by = glm::dvec3(0);
  scene.image.width = 22;
  scene.image.height = 19;
  scene.render.integrator = integrator;
  scene.render.samples = adaptive ? 8 : 2;
  scene.render.max_depth = 3;
  if (adaptive) scene.render.sampling.threshold = 0.05;
  return scene;
}

double sum_of(const Image& image) {
  return std::accumulate(image.data.begin(), image.data.end(), 0.0,
                         [](double sum, float one) { return sum + double(one); });
}

double all_rays(const RayCounts& counts) {
  return double(counts[COUNT_PRIMARY] + counts[COUNT_REFLECTION] + counts[COUNT_REFRACTION] +
                counts[COUNT_SHADOW]);
}

RenderOptions with_rays() {
  RenderOptions options;
  options.aovs = {"rays", "samples"};
  return options;
}

/// Two round panes one behind the other, seen from behind, of a material.
SceneDescription panes(const char* material, const char* integrator) {
  const nlohmann::json document =
      parse_json(fmt::format(R"({{"image": {{"width": 22, "height": 19}}, "render": {{"integrator": "{}"}},
    "camera": {{"position": [0, 0, 5], "target": [0, 0, 0], "orthographic": 4}},
    "lights": [{{"type": "point", "position": [0, 0, 6]}}],
    "media": {{"glass": {{"ior": 1.5}}}},
    "materials": {{"glass": {{"type": "dielectric", "medium": "glass"}}, "matte": {{"color": [0.8, 0.8, 0.8]}}}},
    "objects": [
      {{"type": "disk", "radius": 1.3, "normal": [0, 0, -1], "material": "{}"}},
      {{"type": "disk", "radius": 1.3, "center": [0, 0, -1], "normal": [0, 0, -1], "material": "{}"}}]}})",
                             integrator, material, material),
                 "test.json");
  const JsonContext context{"test.json"};
  return read_scene(JsonValue(document, context));
}

}  // namespace

TEST_CASE("a pixel is counted once, however many of its rays leave what they had not entered") {
  for (const char* integrator : {"whitted", "path"})
    on_picture_devices([&](const DeviceInfo& device) {
      const Image lit = scenes::render_on(device, panes("matte", integrator)).image;
      std::size_t pixels = 0;
      for (int i = 0; i < lit.width * lit.height; ++i) pixels += lit.pixel(i, 0)[0] > 0 ? 1 : 0;
      const RenderResult result = scenes::render_on(device, panes("glass", integrator));
      CHECK(pixels > 90);
      CHECK(result.counts[COUNT_LOST_PIXEL] == pixels);
      CHECK(result.counts[COUNT_STRAY_EXIT] >= 2 * pixels);
      CHECK(scenes::render_on(device, things(integrator, false)).counts[COUNT_LOST_PIXEL] == 0);
    });
}

TEST_CASE("rays of all pixels are those of the statistics, the same for every tile and group") {
  for (const char* integrator : {"whitted", "path"})
    for (const bool adaptive : {false, true}) {
      const SceneDescription scene = things(integrator, adaptive);
      on_picture_devices([&](const DeviceInfo& device) {
        const RenderResult whole = scenes::render_on(device, scene, with_rays());
        const Image& rays = whole.aovs.at("rays");
        CHECK(sum_of(rays) == all_rays(whole.counts));
        CHECK_FALSE(whole.devices.at(0).kernels.contains("first_surfaces"));  // no AOV shows them
        const Image& samples = whole.aovs.at("samples");
        bool each = true, more = false;
        for (std::size_t i = 0; i < rays.data.size(); ++i) {
          each = each && rays.data[i] >= samples.data[i];
          more = more || rays.data[i] > 3 * samples.data[i];
        }
        CHECK(each);
        CHECK(more);
        RenderOptions options = with_rays();
        options.tile = 8;
        options.work_group = {WorkGroup::Kind::fixed, 2, 1};
        const RenderResult tiled = scenes::render_on(device, scene, options);
        CHECK(same_bits(rays, tiled.aovs.at("rays")));
        CHECK(same_bits(whole.image, scenes::render_on(device, scene).image));
      });
    }
}

TEST_CASE("rays are counted on from a checkpoint, and put together from parts") {
  const DeviceInfo& device = test_devices().front();
  const TemporaryFolder folder;
  for (const bool adaptive : {false, true}) {
    const SceneDescription scene = things("whitted", adaptive);
    const Image whole = scenes::render_on(device, scene, with_rays()).aovs.at("rays");
    RenderOptions options = with_rays();
    options.tile = 8;
    options.resume = folder / (adaptive ? "adaptive" : "plain");
    std::atomic<bool> stop{false};
    int seen = 0;
    options.stop = &stop;
    options.on_progress = [&](const RenderProgress&) { stop = ++seen >= 3; };
    CHECK_FALSE(scenes::render_on(device, scene, options).complete);
    options.stop = nullptr;
    options.on_progress = nullptr;
    CHECK(same_bits(whole, scenes::render_on(device, scene, options).aovs.at("rays")));
    if (adaptive) continue;
    std::vector<std::filesystem::path> files;
    for (int part = 1; part <= 2; ++part) {
      RenderOptions one = with_rays();
      one.part = {part, 2};
      one.channels = 0;
      files.push_back(folder / ("part" + std::to_string(part)));
      PartHeader header;
      header.part = one.part;
      header.aovs = one.aovs;
      write_part(files.back(), header, scenes::render_on(device, scene, one).film);
    }
    CHECK(same_bits(whole, merge_parts(files).film.develop_aov("rays")));
  }
}
