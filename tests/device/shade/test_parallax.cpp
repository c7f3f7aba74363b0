// Relief below surfaces: where rays meet it and where its own shadows lie, by closed forms.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "base/error.h"
#include "catch.h"
#include "devices.h"
#include "same_bits.h"
#include "scenes.h"
#include "surface_testing.h"
#include "temporary_folder.h"

using namespace sundog;

namespace {

constexpr double depth = 0.2;

/// A plane with heights from a square of texels that change along u, in [0, 1].
SceneDescription deep_plane(const std::vector<std::uint8_t>& texels, TextureFilter filter) {
  SceneDescription scene = scenes::line_of_sight({0, 5, 0}, {0, 0, 0}, {0, 0, 1});
  scenes::place(scene, PlaneShape{}, scenes::add_white(scene));
  ImageDescription image;
  image.srgb = false;
  image.pixels.width = image.pixels.height = static_cast<int>(texels.size());
  image.pixels.channels = 1;
  for (std::size_t row = 0; row < texels.size(); ++row)
    image.pixels.data.insert(image.pixels.data.end(), texels.begin(), texels.end());
  scene.images.push_back(image);
  TextureDescription texture;
  texture.kind = TEXTURE_IMAGE;
  texture.image = 0;
  texture.filter = filter;
  texture.wrap[0] = texture.wrap[1] = Wrap::clamp;
  scene.textures.push_back(texture);
  scene.materials[0].textures.height = 0;
  scene.materials[0].parallax = depth;
  scene.materials[0].bump = 0;
  return scene;
}

/// The point x of the plane, seen along (run, -1) and lit along (light, 1).
surfaces::Point at(double x, double run, double light = 0) {
  surfaces::Point point;
  const dvec3 d = glm::normalize(dvec3(run, -1, 0)), wi = glm::normalize(dvec3(light, 1, 0));
  point.p = {float(x), 0, 0.5f, 1e-4f};
  point.d = {float(d.x), float(d.y), 0, 0};
  point.wi = {float(wi.x), float(wi.y), 0, 0};
  return point;
}

/// A ball and a box far above, which shine by next to nothing: with them a relief has the kernels of
/// floor_with_things().
void add_things_far_above(SceneDescription& scene) {
  const int material = scenes::add_white(scene);
  scene.materials.back().emission = dvec3(1e-6);
  const glm::dmat4 above = glm::translate(glm::dmat4(1), dvec3(0, 50, 0));
  scenes::place(scene, SphereShape{0.01}, material, above);
  scenes::place(scene, BoxShape{dvec3(0.01)}, material, above);
}

/// High for u below 1/2, low beyond.
SceneDescription wall_plane() {
  std::vector<std::uint8_t> texels(16, 0);
  std::fill_n(texels.begin(), 8, std::uint8_t{255});
  return deep_plane(texels, TextureFilter::nearest);
}

}  // namespace

TEST_CASE("a ray meets heights below a surface where they are, however it slants") {
  const SceneDescription flat = deep_plane({102, 102}, TextureFilter::bilinear);  // 0.4 everywhere
  const SceneDescription slope = deep_plane({0, 255}, TextureFilter::bilinear);
  const SceneDescription wall = wall_plane();
  on_every_device([&](const DeviceInfo& info) {
    for (const double run : {0.0, 0.5, -2.0, 8.0}) {
      const surfaces::Shaded seen = surfaces::shade(info, surfaces::Part::parallax, flat, at(0.3, run));
      CHECK(double(seen.sunk.x) == Approx(0.6).margin(1e-4));
      CHECK(double(seen.sunk.y) == Approx(0.3 + run * 0.6 * depth).margin(2e-4));
      CHECK(double(seen.sunk.z) == Approx(run * 0.6 * depth).margin(2e-4));
    }
    // The heights rise from 0 at u = 1/4 to 1 at u = 3/4: a ray from u0 meets them at a depth of 1 - h.
    for (const double run : {0.0, 0.7, -0.7}) {
      const double h = 2 * (0.45 + run * depth - 0.25) / (1 + 2 * run * depth);
      const surfaces::Shaded seen = surfaces::shade(info, surfaces::Part::parallax, slope, at(0.45, run));
      CHECK(double(seen.sunk.x) == Approx(1 - h).margin(1e-3));
    }
    // Past the wall's upper edge on its floor, and against the wall.
    CHECK(double(surfaces::shade(info, surfaces::Part::parallax, wall, at(0.9, -1)).sunk.y) ==
          Approx(0.7).margin(1e-3));
    CHECK(double(surfaces::shade(info, surfaces::Part::parallax, wall, at(0.6, -1)).sunk.y) ==
          Approx(0.5).margin(3e-3));
    CHECK(double(surfaces::shade(info, surfaces::Part::parallax, wall, at(0.6, -1)).sunk.x) ==
          Approx(0.5).margin(0.02));
    CHECK(double(surfaces::shade(info, surfaces::Part::parallax, wall, at(0.4, -1)).sunk.x) == 0);
  });
}

TEST_CASE("a wall below a surface throws its shadow on its floor, as long as the light is low") {
  const SceneDescription wall = wall_plane();
  on_every_device([&](const DeviceInfo& info) {
    const auto lit = [&](double x, double light) {
      return surfaces::shade(info, surfaces::Part::parallax, wall, at(x, 0, light)).sunk.w;
    };
    for (const double light : {0.5, 1.0, 2.0}) {
      INFO(light);
      CHECK(lit(0.5 + 0.8 * light * depth, -light) == 0);  // the light stands behind the wall
      CHECK(lit(0.5 + 1.3 * light * depth, -light) == 1);
      CHECK(lit(0.5 + 0.8 * light * depth, light) == 1);  // and before it
      CHECK(lit(0.4, -light) == 1);                       // on top
    }
  });
}

TEST_CASE("a surface with heights below it is one without them from behind, and where they are white") {
  const SceneDescription white = deep_plane({255, 255}, TextureFilter::bilinear);
  const SceneDescription black = deep_plane({0, 0}, TextureFilter::bilinear);
  on_every_device([&](const DeviceInfo& info) {
    CHECK(surfaces::shade(info, surfaces::Part::parallax, white, at(0.3, 1)).sunk.x == 0);
    surfaces::Point behind = at(0.3, 1);
    behind.d.y = -behind.d.y;
    CHECK(surfaces::shade(info, surfaces::Part::parallax, black, behind).sunk.x == 0);
    CHECK(double(surfaces::shade(info, surfaces::Part::parallax, black, at(0.3, 1)).sunk.x) == Approx(1));
  });
}

namespace {

/// A ball and a box that stand in a floor, which is at y = 0 with a relief as deep as `sunk` everywhere, or
/// lies that deep itself.
SceneDescription floor_with_things(bool relief, double sunk) {
  const auto height = static_cast<std::uint8_t>(std::lround(255 * (1 - sunk / depth)));
  SceneDescription scene = deep_plane({height, height}, TextureFilter::bilinear);
  scene.camera.position = {1.5, 1.6, 2.2};
  scene.camera.target = {0, -0.05, 0};
  scene.camera.up = {0, 1, 0};
  scene.camera.fov = 35;
  scene.image.width = scene.image.height = 48;
  scene.materials[0].diffuse = dvec3(0);
  scene.materials[0].emission = {0.1, 0.2, 0.9};
  if (!relief) {
    scene.materials[0].parallax = 0;
    scene.materials[0].textures.height = -1;
    scene.objects[0].world_from_object = glm::translate(dmat4(1), dvec3(0, -sunk, 0));
  }
  scenes::place(scene, SphereShape{0.3}, scenes::add_white(scene),
                glm::translate(dmat4(1), dvec3(-0.4, -0.02, 0.1)));
  scene.materials.back().emission = {0, 0.3, 0};
  scenes::place(scene, BoxShape{dvec3(0.2)}, scenes::add_white(scene),
                glm::rotate(glm::translate(dmat4(1), dvec3(0.45, -0.05, -0.2)), 0.5, dvec3(0, 1, 0)));
  scene.materials.back().emission = {0.7, 0.1, 0};
  LightDescription sun;
  sun.type = LightType::directional;
  sun.direction = {-0.3, -1, -0.5};
  scene.lights.push_back(sun);
  return scene;
}

}  // namespace

TEST_CASE("what stands in a relief is seen as in a floor that lies as deep, and light reaches it there") {
  constexpr double sunk = 0.6 * depth;  // a height of 102 of 255
  on_picture_devices([&](const DeviceInfo& info) {
    for (const char* integrator : {"whitted", "path"}) {
      INFO(integrator);
      SceneDescription floors[2] = {floor_with_things(true, sunk), floor_with_things(false, sunk)};
      Image images[2], above;
      for (int i = 0; i < 2; ++i) {
        floors[i].render.integrator = integrator;
        floors[i].render.max_depth = integrator == std::string("path") ? 0 : 1;  // no light that bounces
        images[i] = scenes::render_on(info, floors[i]).image;
      }
      floors[1].objects[0].world_from_object = dmat4(1);
      above = scenes::render_on(info, floors[1]).image;
      int differ = 0, changed = 0;
      for (std::size_t i = 0; i < images[0].data.size(); i += 4) {
        const auto apart = [&](const Image& a, const Image& b) {
          double most = 0;
          for (std::size_t c = 0; c < 3; ++c)
            most = std::max(most, std::abs(double(a.data[i + c]) - double(b.data[i + c])));
          return most > 0.01;
        };
        differ += apart(images[0], images[1]);
        changed += apart(above, images[1]);
      }
      CHECK(changed > 40);  // of 2304: the things are cut elsewhere by a floor that is not sunk
      CHECK(differ <= 4);   // where a pixel's ray grazes
    }
  });
}

TEST_CASE("a frame with an image and a relief has the same bits for every work-group and tile") {
  const SceneDescription scene = floor_with_things(true, 0.6 * depth);
  on_picture_devices([&](const DeviceInfo& info) {
    const Image whole = scenes::render_on(info, scene).image;
    for (const std::size_t size : {1u, 3u, 64u}) {
      RenderOptions options;
      options.work_group = {WorkGroup::Kind::fixed, size, 1};
      CHECK(same_bits(scenes::render_on(info, scene, options).image, whole));
    }
    for (const int tile : {4, 17, 33}) {
      RenderOptions options;
      options.tile = tile;
      CHECK(same_bits(scenes::render_on(info, scene, options).image, whole));
    }
  });
}

TEST_CASE("an interrupted frame with an image and a relief is resumed to the same bits") {
  const SceneDescription scene = floor_with_things(true, 0.6 * depth);
  const DeviceInfo device = test_devices().front();
  const TemporaryFolder folder;
  const Image whole = scenes::render_on(device, scene).image;
  std::atomic<bool> stop{false};
  RenderOptions options;
  options.tile = 8;
  options.resume = folder.path() / "frame.checkpoint";
  options.stop = &stop;
  options.on_progress = [&](const RenderProgress& progress) {
    stop = progress.pixels_done > progress.pixels_total / 3;
  };
  REQUIRE_FALSE(scenes::render_on(device, scene, options).complete);
  SECTION("with what was done kept") {
    options.stop = nullptr;
    options.on_progress = {};
    CHECK(same_bits(scenes::render_on(device, scene, options).image, whole));
  }
  SECTION("but not with another image") {
    SceneDescription other = scene;
    other.images[0].pixels.data[0] ^= 1;
    CHECK_THROWS_AS(scenes::render_on(device, other, options), UsageError);
  }
}

namespace {

/// Pixels that differ by more than 0.01 in some channel.
int differing(const Image& a, const Image& b) {
  int count = 0;
  for (std::size_t i = 0; i < a.data.size(); i += 4) {
    double most = 0;
    for (std::size_t c = 0; c < 3; ++c)
      most = std::max(most, std::abs(double(a.data[i + c]) - double(b.data[i + c])));
    count += most > 0.01;
  }
  return count;
}

/// The plane with heights that rise along u, from 0 at u = 1/104 to 1 at u = 103/104, seen from above at a
/// slant.
SceneDescription seen_slope() {
  std::vector<std::uint8_t> texels;
  for (int height = 0; height < 256; height += 5) texels.push_back(static_cast<std::uint8_t>(height));
  SceneDescription scene = deep_plane(texels, TextureFilter::bilinear);
  scene.materials[0].bump = depth;
  scene.camera.position = {0.5, 1, 0.6};
  scene.camera.target = {0.5, -0.1, -0.5};
  scene.camera.up = {0, 1, 0};
  scene.camera.fov = 12;
  scene.image.width = scene.image.height = 16;
  add_things_far_above(scene);
  return scene;
}

}  // namespace

TEST_CASE("AOVs of a relief are those of the point that is seen in it") {
  const SceneDescription scene = seen_slope();
  RenderOptions options;
  options.aovs = {"depth", "normal", "position", "uv"};
  on_picture_devices([&](const DeviceInfo& info) {
    const RenderResult result = scenes::render_on(info, scene, options);
    const dvec3 eye = scene.camera.position, forward = glm::normalize(scene.camera.target - eye);
    const dvec3 slope = glm::normalize(dvec3(-depth * 52 / 51, 1, 0));
    for (int y = 0; y < 16; ++y)
      for (int x = 0; x < 16; ++x) {
        const float* p = result.aovs.at("position").pixel(x, y);
        const float *n = result.aovs.at("normal").pixel(x, y), *uv = result.aovs.at("uv").pixel(x, y);
        const dvec3 at{double(p[0]), double(p[1]), double(p[2])};
        INFO(x << " " << y << " " << at.x << " " << at.y << " " << at.z);
        CHECK(at.y == Approx(depth * ((52 * at.x - 0.5) / 51 - 1)).margin(1e-3));
        CHECK(double(uv[0]) == Approx(at.x).margin(1e-4));
        CHECK(double(uv[1]) == Approx(-at.z).margin(1e-4));
        CHECK(double(result.aovs.at("depth").pixel(x, y)[0]) ==
              Approx(glm::dot(at - eye, forward)).margin(1e-5));
        CHECK(glm::dot(slope, dvec3(double(n[0]), double(n[1]), double(n[2]))) > 0.9999);
      }
  });
}

TEST_CASE("AOVs show what stands in a relief") {
  constexpr double sunk = 0.6 * depth;
  RenderOptions options;
  options.aovs = {"depth", "object", "position"};
  on_picture_devices([&](const DeviceInfo& info) {
    const RenderResult relief = scenes::render_on(info, floor_with_things(true, sunk), options);
    const RenderResult sunken = scenes::render_on(info, floor_with_things(false, sunk), options);
    int differ = 0;
    for (int y = 0; y < 48; ++y)
      for (int x = 0; x < 48; ++x)
        differ +=
            relief.aovs.at("object").pixel(x, y)[0] != sunken.aovs.at("object").pixel(x, y)[0] ||
            std::abs(relief.aovs.at("depth").pixel(x, y)[0] - sunken.aovs.at("depth").pixel(x, y)[0]) > 2e-3f;
    CHECK(differ <= 4);
  });
}

TEST_CASE("a relief's walls throw their shadows on what stands among them") {
  // A flat thing half as deep as the wall's foot, lit from behind the wall at 45 degrees.
  SceneDescription scene = wall_plane();
  scene.camera.position = {0.75, 4, -0.5};
  scene.camera.target = {0.75, 0, -0.5};
  scene.camera.up = {0, 0, -1};
  scene.camera.fov = 1.5;
  scene.image.width = 32, scene.image.height = 4;
  scene.materials[0].diffuse = dvec3(0);
  scenes::place(scene, BoxShape{dvec3(0.5, 0.01, 0.5)}, scenes::add_white(scene),
                glm::translate(dmat4(1), dvec3(1.05, -0.11, -0.5)));
  LightDescription sun;
  sun.type = LightType::directional;
  sun.direction = {1, -1, 0};
  scene.lights = {sun};
  add_things_far_above(scene);
  RenderOptions options;
  options.aovs = {"position"};
  on_picture_devices([&](const DeviceInfo& info) {
    for (const char* integrator : {"whitted", "path"}) {
      INFO(integrator);
      scene.render.integrator = integrator;
      scene.render.max_depth = 1;
      const RenderResult result = scenes::render_on(info, scene, options);
      int dark = 0, light = 0;
      for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 32; ++x) {
          const float* p = result.aovs.at("position").pixel(x, y);
          if (std::abs(p[1] + 0.1f) > 1e-3f) continue;  // on top of the thing
          if (std::abs(p[0] - 0.6f) < 0.012f) continue;
          const bool lit = result.image.pixel(x, y)[0] > 0.01f;
          INFO(p[0]);
          CHECK(lit == (p[0] > 0.6f));  // 0.1 below the wall's top, which ends at 0.5
          (lit ? light : dark) += 1;
        }
      CHECK(dark >= 4);
      CHECK(light >= 40);
    }
  });
}

namespace {

/// Glass over a pattern of light: its upper face lies `sunk` deep, as a relief or itself.
SceneDescription glass_with_things(bool relief, double sunk) {
  SceneDescription scene = floor_with_things(relief, sunk);
  scene.media.push_back({"glass", 1.5, dvec3(0.5, 0.1, 0)});
  MaterialDescription& glass = scene.materials[0];
  glass.emission = glass.diffuse = dvec3(0);
  glass.type = MaterialType::dielectric;
  glass.transmission = dvec3(1);  // light that is mirrored leaves where the plain surface is
  glass.medium = static_cast<int>(scene.media.size()) - 1;
  // The block's upper face is y = 0, or lower; its lower one is y = -1.
  const double top = relief ? 0 : -sunk;
  scene.objects[0].shape = BoxShape{dvec3(3, (top + 1) / 2, 3)};
  scene.objects[0].world_from_object = glm::translate(dmat4(1), dvec3(0, (top - 1) / 2, 0));
  scenes::place(scene, BoxShape{dvec3(0.5, 0.1, 0.5)}, scenes::add_white(scene),
                glm::translate(dmat4(1), dvec3(0.2, -1.3, -0.6)));
  scene.materials.back().emission = {0.2, 0.2, 0.9};
  for (MaterialDescription& material : scene.materials) material.diffuse = dvec3(0);
  scene.lights = {};
  return scene;
}

}  // namespace

TEST_CASE("a transparent relief bends light at its heights, and things stand in it") {
  constexpr double sunk = 0.6 * depth;
  on_picture_devices([&](const DeviceInfo& info) {
    for (const char* integrator : {"whitted", "path"}) {
      INFO(integrator);
      Image images[3];
      for (int i = 0; i < 3; ++i) {
        SceneDescription scene = glass_with_things(i == 0, i == 2 ? 0 : sunk);
        scene.render.integrator = integrator;
        scene.render.max_depth = 4;
        images[i] = scenes::render_on(info, scene).image;
      }
      CHECK(differing(images[1], images[2]) > 60);
      CHECK(differing(images[0], images[1]) <= 8);
    }
  });
}
