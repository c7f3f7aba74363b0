// sundog's pictures against POV-Ray's of the same scenes, where POV-Ray is installed. Both take one sample at
// each pixel's centre and follow every ray. Shadows are compared apart: POV-Ray's shadow rays pass through
// glass without loss, ours lose what each interface reflects. So transmissive things first cast opaque
// shadows in both pictures; then, with filtering shadows, the pictures may differ only where those shadows
// reach.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <glm/gtc/matrix_transform.hpp>

#include "base/environment.h"
#include "base/image_compare.h"
#include "base/image_io.h"
#include "catch.h"
#include "compile/compiled_scene.h"
#include "device/devices.h"
#include "povray_from_scene.h"
#include "povray_run.h"
#include "render/render.h"
#include "scene/load.h"
#include "scenes.h"

using namespace sundog;

namespace {

const std::filesystem::path folder =
    std::filesystem::path(SUNDOG_BINARY).parent_path() / "test_output" / "povray";

struct Pictures {
  std::string name;
  Image ours, theirs;
};

// POV-Ray's picture ends at 1.
Image clamped(Image image) {
  for (float& value : image.data) value = std::clamp(value, 0.0f, 1.0f);
  return image;
}

SceneDescription load(const std::string& scene_name, std::vector<std::string> overrides) {
  for (const char* common : {"/image/width=192", "/image/height=144", "/render/samples=1", "/render/cutoff=0",
                             "/render/max_depth=7"})
    overrides.emplace_back(common);
  SceneDescription scene =
      load_scene(std::filesystem::path(SUNDOG_SOURCE_DIR) / "scenes" / (scene_name + ".json"), overrides);
  // Below what everything stands on lie the shapes of all scenes: the same kernels draw them.
  const glm::dmat4 below = glm::translate(glm::dmat4(1), {0, -3, 0});
  scenes::place(scene, CylinderShape{0.1, 0.1}, scene.objects.front().material, below);
  scenes::place(scene, RoundBoxShape{{0.1, 0.1, 0.1}, 0.02}, scene.objects.front().material, below);
  return scene;
}

/// General kernels draw the bits of the scene's own, and several scenes share them.
Image our_picture(const SceneDescription& scene, KernelChoice kernels = KernelChoice::general) {
  RenderOptions options;
  options.kernels = kernels;
  return clamped(
      render(compile(scene), select_devices(enumerate_devices(plain_environment()), {}), options).image);
}

bool differ(const Image& a, const Image& b, int x, int y, float tolerance) {
  for (int c = 0; c < 3; c++)
    if (std::abs(a.pixel(x, y)[c] - b.pixel(x, y)[c]) > tolerance) return true;
  return false;
}

// The rays of our_picture(), through the centers of pixels a ninth as wide: checkers are filtered as finely.
Image sharp_picture(SceneDescription scene) {
  const int finer = 9;
  scene.image.width *= finer;
  scene.image.height *= finer;
  const Image fine = our_picture(scene);
  Image image(scene.image.width / finer, scene.image.height / finer, fine.channels);
  for (int y = 0; y < image.height; y++)
    for (int x = 0; x < image.width; x++)
      std::copy_n(fine.pixel(finer * x + finer / 2, finer * y + finer / 2), fine.channels, image.pixel(x, y));
  return image;
}

// Our picture; where its filter of checkers shows, which POV-Ray does not have, the pixel is POV-Ray's. Cells
// must be wider than a ninth of a pixel: a floor ends before the horizon.
Image without_borders(const SceneDescription& scene, const Image& theirs) {
  const Image filtered = our_picture(scene);
  Image image = sharp_picture(scene);
  int borders = 0;
  for (int y = 0; y < image.height; y++)
    for (int x = 0; x < image.width; x++)
      if (differ(image, filtered, x, y, 0.001f)) {
        borders++;
        std::copy_n(theirs.pixel(x, y), 3, image.pixel(x, y));
      }
  CHECK(borders < 0.35 * image.width * image.height);
  return image;
}

Pictures render_both(const std::string& scene_name, const std::string& name,
                     const std::vector<std::string>& overrides) {
  const SceneDescription scene = load(scene_name, overrides);
  const std::string text = povray::from_scene(scene, povray::Absorption::media);
  const Image theirs = povray::run(text, scene.image.width, scene.image.height, 2, folder, name).image;
  return {name, without_borders(scene, theirs), theirs};
}

// Says how the pictures differ, and leaves ours and the difference beside POV-Ray's.
ImageDifference report(const Pictures& pictures) {
  const ImageDifference d = compare_images(pictures.ours, pictures.theirs, 0.01);
  write_image(pictures.ours, folder / (pictures.name + "_sundog.png"));
  write_image(difference_image(pictures.ours, pictures.theirs), folder / (pictures.name + "_difference.png"));
  std::printf(
      "%s against POV-Ray: mean %.6f, 99th percentile %.5f, greatest %.3f; %.2f %% of the pixels off by more "
      "than "
      "0.01 (pictures in %s)\n",
      pictures.name.c_str(), d.mean, d.percentile_99, d.max,
      100 * static_cast<double>(d.over_tolerance) / static_cast<double>(d.pixels), folder.c_str());
  return d;
}

// The share of pixels off by more than 0.01 although POV-Ray's picture does not depend on how transmissive
// things cast shadows there.
double unexplained(const Pictures& filtering, const Pictures& opaque) {
  int count = 0;
  for (int y = 0; y < filtering.ours.height; y++)
    for (int x = 0; x < filtering.ours.width; x++)
      count += differ(filtering.ours, filtering.theirs, x, y, 0.01f) &&
               !differ(filtering.theirs, opaque.theirs, x, y, 0.001f);
  return static_cast<double>(count) / (filtering.ours.width * filtering.ours.height);
}

bool povray_missing() {
  if (!povray::installed_version().empty()) return false;
  std::printf("POV-Ray is not installed: its pictures were not compared (apt-get install povray)\n");
  return true;
}

void check_same(const Pictures& pictures) {
  const ImageDifference d = report(pictures);
  CHECK(d.mean < 0.0003);
  CHECK(d.percentile_99 < 0.002);
  CHECK(static_cast<double>(d.over_tolerance) < 0.002 * static_cast<double>(d.pixels));
}

void check_scene(const std::string& scene, const std::vector<std::string>& overrides,
                 std::vector<std::string> opaque_shadows) {
  opaque_shadows.insert(opaque_shadows.end(), overrides.begin(), overrides.end());
  const Pictures opaque = render_both(scene, scene, opaque_shadows);
  check_same(opaque);
  SceneDescription compact = load(scene, opaque_shadows);
  compact.render.tracer = Tracer::compact;
  check_same({scene + "_compact", without_borders(compact, opaque.theirs), opaque.theirs});

  const Pictures filtering = render_both(scene, scene + "_filtering_shadows", overrides);
  report(filtering);
  const double outside = unexplained(filtering, opaque);
  std::printf(
      "%s: %.3f %% of the pixels are off by more than 0.01 and not in the shadow of something transmissive\n",
      scene.c_str(), 100 * outside);
  CHECK(outside < 0.003);
}

}  // namespace

TEST_CASE("spheres look as POV-Ray shows them", "[povray]") {
  if (povray_missing()) return;
  check_scene("spheres",
              {R"(/objects/0={"type": "box", "min": [-9, -2, -9], "max": [9, -1, 9], "material": "floor"})"},
              {"/materials/glass/shadow=opaque"});
}

TEST_CASE("the exact hollow ice looks as POV-Ray shows it", "[povray]") {
  if (povray_missing()) return;
  check_scene("hollow_ice_exact", {},
              {"/materials/ice/shadow=opaque", "/materials/liquid/shadow=opaque",
               "/materials/cavity/shadow=opaque", "/materials/bubble/shadow=opaque"});
}

TEST_CASE("a quaternion Julia set is POV-Ray's julia_fractal: the same outlines and shades") {
  if (povray_missing()) return;
  const std::filesystem::path file = std::filesystem::path(SUNDOG_SOURCE_DIR) / "bench/scenes/julia.json";
  const SceneDescription scene = load_scene(
      file,
      {"/image/width=240", "/image/height=240", "/objects/0/detail=0.1", "/objects/0/least_threshold=1e-6"});
  const Pictures pictures{
      "julia", our_picture(scene, KernelChoice::own),
      povray::run(povray::from_scene(scene, povray::Absorption::media), 240, 240, 2, folder, "julia").image};
  const ImageDifference d = report(pictures);
  const glm::dvec3 sky = scene.image.background_top;
  int outlines = 0, bodies = 0;
  double shades = 0;
  for (int y = 0; y < 240; y++)
    for (int x = 0; x < 240; x++) {
      const auto is_sky = [&](const Image& image) { return std::abs(image.pixel(x, y)[0] - sky.x) < 1e-3; };
      outlines += is_sky(pictures.ours) != is_sky(pictures.theirs);
      if (is_sky(pictures.ours) || is_sky(pictures.theirs)) continue;
      bodies++;
      for (int c = 0; c < 3; c++)
        shades += std::abs(pictures.ours.pixel(x, y)[c] - pictures.theirs.pixel(x, y)[c]) / 3;
    }
  std::printf("julia: %d of %d pixels on the other side of an outline; shades differ by %.4f in the mean\n",
              outlines, 240 * 240, shades / bodies);
  CHECK(d.pixels == 240 * 240);
  CHECK(bodies > 20000);
  CHECK(outlines < 240 * 240 / 50);
  CHECK(shades / bodies < 0.03);
}
