// Bent normals, metalness and roughness from textures, and computed patterns, where closed forms are known.
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "catch.h"
#include "devices.h"
#include "scenes.h"
#include "surface_testing.h"

using namespace sundog;

namespace {

ImageDescription pixel(std::vector<std::uint8_t> rgba, bool srgb = false) {
  ImageDescription image;
  image.srgb = srgb;
  image.pixels.width = image.pixels.height = 1;
  image.pixels.data = std::move(rgba);
  return image;
}

SceneDescription white_plane() {
  SceneDescription scene = scenes::line_of_sight({0.3, 5, 0.2}, {0.3, 0, 0.2}, {0, 0, 1});
  scenes::place(scene, PlaneShape{}, scenes::add_white(scene));
  return scene;
}

int add_image(SceneDescription& scene, const ImageDescription& image) {
  TextureDescription texture;
  texture.kind = TEXTURE_IMAGE;
  texture.image = static_cast<int>(scene.images.size());
  scene.images.push_back(image);
  scene.textures.push_back(texture);
  return static_cast<int>(scene.textures.size()) - 1;
}

int add_pattern(SceneDescription& scene, TextureKind kind, double size = 1) {
  TextureDescription texture;
  texture.kind = kind;
  texture.mapping = Mapping::object;
  texture.placement = glm::scale(glm::dmat4(1), dvec3(1 / size));
  scene.textures.push_back(texture);
  return static_cast<int>(scene.textures.size()) - 1;
}

/// The plane's point (x, z) seen from above.
surfaces::Point above(double x = 0.3, double z = 0.2, double footprint = 1e-3) {
  surfaces::Point point;
  point.p = {float(x), 0, float(z), float(footprint)};
  return point;
}

dvec3 xyz(const float4& v) { return {double(v.x), double(v.y), double(v.z)}; }

/// The texture's value at (x, z), where it is the plane's emission.
double pattern_at(const DeviceInfo& info, const SceneDescription& scene, double x, double z,
                  double footprint = 1e-4) {
  return double(surfaces::shade(info, surfaces::Part::value, scene, above(x, z, footprint)).value.x);
}

}  // namespace

TEST_CASE("a normal map bends the normal along u and v of the surface") {
  SceneDescription scene = white_plane();
  // On a plane u goes along x and v along -z: the map's normal (0.4, -0.2, z).
  const auto byte = [](double v) { return static_cast<std::uint8_t>(std::lround(255 * (0.5 + 0.5 * v))); };
  scene.materials[0].textures.normal = add_image(scene, pixel({byte(0.4), byte(-0.2), byte(0.9), 255}));
  const auto value = [&](double v) { return byte(v) / 127.5 - 1; };
  const dvec3 n = glm::normalize(dvec3(value(0.4), value(0.9), -value(-0.2)));
  on_every_device([&](const DeviceInfo& info) {
    CHECK(glm::length(xyz(surfaces::shade(info, surfaces::Part::relief, scene, above()).normal) - n) < 2e-4);
  });
}

TEST_CASE("bent normals leak no light from behind the surface, and end softly at its terminator") {
  SceneDescription scene = white_plane();
  scene.materials[0].textures.normal = add_image(scene, pixel({255, 128, 128, 255}));
  on_every_device([&](const DeviceInfo& info) {
    const auto kept = [&](double height) {
      surfaces::Point point = above();
      const dvec3 wi = glm::normalize(dvec3(1, height, 0));
      point.wi = {float(wi.x), float(wi.y), 0, 0};
      return double(surfaces::shade(info, surfaces::Part::relief, scene, point).normal.w);
    };
    CHECK(kept(-0.05) == 0);
    CHECK(kept(1e-4) < 0.1);
    CHECK(kept(2e-3) > kept(1e-3));
    CHECK(kept(2e-3) < 1);
    CHECK(kept(0.5) == Approx(2 / (1 + std::sqrt(1 + 4.0))).epsilon(1e-3));
  });
}

TEST_CASE("a normal map turns with its picture, as heights do") {
  on_every_device([&](const DeviceInfo& info) {
    for (const int degrees : {0, 90, 180, 217}) {
      for (const double flip : {1.0, -1.0}) {
        SceneDescription scene = white_plane();
        scene.materials[0].textures.normal = add_image(scene, pixel({204, 128, 230, 255}));  // (0.6, 0, 0.8)
        const double c = std::cos(glm::radians(double(degrees))), s = std::sin(glm::radians(double(degrees)));
        scene.textures[0].uv = glm::dmat3(2 * flip, 0, 0, 0, 3, 0, 0, 0, 1) *
                               glm::dmat3(glm::dvec3(c, -s, 0), glm::dvec3(s, c, 0), glm::dvec3(0.3, 0.1, 1));
        // u of the plane is x, v is -z.
        const dvec3 n = xyz(surfaces::shade(info, surfaces::Part::relief, scene, above()).normal);
        INFO(degrees << ", " << flip);
        CHECK(n.x == Approx(0.6 * flip * c).margin(5e-3));
        CHECK(-n.z == Approx(0.6 * flip * s).margin(5e-3));
        CHECK(n.y == Approx(0.8).margin(5e-3));
      }
    }
  });
}

TEST_CASE("bent normals return no more light than comes, however far they are bent") {
  // A white Lambert surface under light from all sides: the mean of 2 (n . wi) over the hemisphere.
  std::vector<surfaces::Point> points;
  constexpr int rows = 24, columns = 16;
  for (int i = 0; i < rows * columns; ++i) {
    const double up = (i / columns + 0.5) / rows,
                 angle = 2 * std::numbers::pi * (i % columns + 0.5) / columns;
    const double side = std::sqrt(1 - up * up);
    points.push_back(above());
    points.back().wi = {float(side * std::cos(angle)), float(up), float(side * std::sin(angle)), 0};
  }
  on_every_device([&](const DeviceInfo& info) {
    for (const int tilt : {128, 166, 204, 242}) {
      SceneDescription scene = white_plane();
      const double x = tilt / 127.5 - 1, z = std::sqrt(1 - x * x);
      scene.materials[0].textures.normal =
          add_image(scene, pixel({static_cast<std::uint8_t>(tilt), 128,
                                  static_cast<std::uint8_t>(std::lround(127.5 + 127.5 * z)), 255}));
      double sum = 0;
      const std::vector<surfaces::Shaded> shaded =
          surfaces::shade(info, surfaces::Part::relief, compile(scene), points);
      for (std::size_t i = 0; i < points.size(); ++i)
        sum += 2 * double(shaded[i].normal.w) *
               std::max(glm::dot(xyz(shaded[i].normal), xyz(points[i].wi)), 0.0);
      const double returned = sum / double(points.size());
      INFO("tilted to " << x << ": " << returned);
      CHECK(returned < 1.005);
      CHECK(returned > 0.45);
    }
  });
}

TEST_CASE("normals that differ within a footprint make highlights wider and weaker, and their mean is unit") {
  SceneDescription scene = white_plane();
  ImageDescription image =
      pixel({204, 128, 230, 255, 51, 128, 230, 255});  // (0.6, 0, 0.8) and (-0.6, 0, 0.8)
  image.pixels.width = 2;
  scene.materials[0].textures.normal = add_image(scene, image);
  on_every_device([&](const DeviceInfo& info) {
    const auto seen = [&](double footprint) {
      return surfaces::shade(info, surfaces::Part::relief, scene, above(0.25, 0.5, footprint));
    };
    CHECK(double(seen(1e-3).value.x) == Approx(1).margin(1e-3));
    CHECK(double(seen(1e-3).value.y) == Approx(50).epsilon(1e-3));
    const surfaces::Shaded far = seen(20);
    const double even = 230 / 127.5 - 1 + 0.01, wide = 50 * even / (even + 50 * (1 - even));
    CHECK(double(far.value.x) == Approx(even).margin(5e-3));
    CHECK(double(far.value.y) == Approx(wide).epsilon(0.05));
    CHECK(double(far.value.z) == Approx((1 + wide) / 51).epsilon(0.05));
    CHECK(glm::length(xyz(far.normal) - dvec3(0, 1, 0)) < 0.01);
  });
}

TEST_CASE("heights bend the normal by their slope, whatever the object's size") {
  for (const double size : {1.0, 3.0}) {
    SceneDescription scene = white_plane();
    scene.objects[0].world_from_object = glm::scale(glm::dmat4(1), dvec3(size));
    scene.materials[0].textures.height = add_pattern(scene, TEXTURE_GRADIENT);  // rises by 1 on a unit of x
    scene.materials[0].bump = 0.5;
    const dvec3 n = glm::normalize(dvec3(-0.5, 1, 0));
    on_every_device([&](const DeviceInfo& info) {
      CHECK(glm::length(xyz(surfaces::shade(info, surfaces::Part::relief, scene, above()).normal) - n) <
            1e-3);
    });
  }
}

TEST_CASE("metalness and roughness from a texture give the terms that they stand for") {
  SceneDescription scene = white_plane();
  const double rough = 153 / 255.0, metal = 102 / 255.0, f = 0.04, mirror = metal * (1 - rough) * (1 - rough);
  const dvec3 base{0.8, 0.5, 0.2};
  MaterialDescription& m = scene.materials[0];
  m.metal_rough = MetalRough{base, 1, 1, f};
  m.textures.metal_rough = add_image(scene, pixel({0, 153, 102, 255}));
  on_every_device([&](const DeviceInfo& info) {
    const surfaces::Shaded found = surfaces::shade(info, surfaces::Part::metal_rough, scene, above());
    const auto check = [](const float4& value, const dvec3& wanted) {
      for (int c = 0; c < 3; ++c) CHECK(xyz(value)[c] == Approx(wanted[c]).epsilon(2e-4));
    };
    // The light of a white surrounding that (n.h)^e returns along the normal, over pi; at most half of what
    // is no mirror.
    const double e = 2 / std::pow(rough, 4) - 2, energy = 8 / (e + 2) * (1 - std::pow(2, -(e + 2) / 2));
    const double lobe = std::min(energy, 0.5 * (1.002 - mirror));
    const dvec3 below = base * (1 - mirror - lobe * (metal + f * (1 - metal)));
    check(found.diffuse, below);
    check(found.ambient, 0.1 * below);
    check(found.specular, lobe / energy * glm::mix(dvec3(f), base, metal));
    check(found.reflection, base * mirror);
    CHECK(double(found.diffuse.w) == Approx(2 / std::pow(rough, 4) - 2).epsilon(2e-4));
  });
}

TEST_CASE("a clear layer takes its mirror's share of all that lies below") {
  SceneDescription scene = white_plane();
  MaterialDescription& m = scene.materials[0];
  m.metal_rough = MetalRough{{0.8, 0.5, 0.2}, 1, 1, 0.04};
  m.textures.metal_rough = add_image(scene, pixel({0, 153, 102, 255}));
  SceneDescription coated = scene;
  coated.materials[0].coat = 0.25;
  on_every_device([&](const DeviceInfo& info) {
    const surfaces::Shaded bare = surfaces::shade(info, surfaces::Part::metal_rough, scene, above());
    const surfaces::Shaded under = surfaces::shade(info, surfaces::Part::metal_rough, coated, above());
    for (int c = 0; c < 3; ++c) {
      CHECK(xyz(under.ambient)[c] == Approx(0.75 * xyz(bare.ambient)[c]));
      CHECK(xyz(under.diffuse)[c] == Approx(0.75 * xyz(bare.diffuse)[c]));
      CHECK(xyz(under.specular)[c] == Approx(0.75 * xyz(bare.specular)[c]));
      CHECK(xyz(under.reflection)[c] == Approx(0.25 + 0.75 * xyz(bare.reflection)[c]));
    }
  });
}

TEST_CASE("patterns have their values near by, and their means far away") {
  SceneDescription checker = white_plane(), stripes = checker, noise = checker;
  checker.materials[0].textures.emission = add_pattern(checker, TEXTURE_CHECKER, 0.5);
  stripes.materials[0].textures.emission = add_pattern(stripes, TEXTURE_STRIPES, 2);
  stripes.textures[0].parameter[0] = 0.25;
  noise.materials[0].textures.emission = add_pattern(noise, TEXTURE_NOISE, 0.7);
  noise.textures[0].parameter[0] = 4, noise.textures[0].parameter[1] = 0.5,
  noise.textures[0].parameter[2] = 1;
  SceneDescription bricks = white_plane();  // of the second course
  bricks.materials[0].textures.emission = add_pattern(bricks, TEXTURE_BRICK);
  bricks.textures[0].placement = glm::translate(glm::dmat4(1), dvec3(0, 1.5, 0));
  bricks.textures[0].parameter[0] = 0.2, bricks.textures[0].parameter[1] = 0.1;
  on_every_device([&](const DeviceInfo& info) {
    CHECK(pattern_at(info, checker, 0.25, 0.25) == Approx(0).margin(1e-6));
    CHECK(pattern_at(info, checker, 0.75, 0.25) == Approx(1).margin(1e-6));
    CHECK(pattern_at(info, checker, 0.75, -0.25) == Approx(0).margin(1e-6));
    CHECK(pattern_at(info, stripes, 1.0, 0) == Approx(0).margin(1e-6));  // the first three quarters of 2
    CHECK(pattern_at(info, stripes, 1.8, 0) == Approx(1).margin(1e-6));
    CHECK(pattern_at(info, bricks, 0.25, 0) == Approx(0).margin(1e-6));
    CHECK(pattern_at(info, bricks, 0.35, 0) == Approx(1).margin(1e-6));  // mortar ends at half a brick
    const double near = pattern_at(info, noise, 0.31, 0.17);
    CHECK(near > 0.05);
    CHECK(near < 0.95);
    CHECK(near != Approx(0.5).margin(1e-3));
    CHECK(pattern_at(info, checker, 0.1, 0.2, 140) == Approx(0.5).margin(0.01));
    CHECK(pattern_at(info, stripes, 0.1, 0.2, 140) == Approx(0.25).margin(0.01));
    CHECK(pattern_at(info, noise, 0.1, 0.2, 140) == Approx(0.5).margin(1e-4));
  });
}

TEST_CASE("a plane on the border of two courses or stripes has the colour of one") {
  on_every_device([&](const DeviceInfo& info) {
    for (const double off : {-1e-7, 1e-7})  // by rounding
      for (const TextureKind kind : {TEXTURE_BRICK, TEXTURE_STRIPES}) {
        SceneDescription scene = white_plane();
        scene.materials[0].textures.emission = add_pattern(scene, kind);
        scene.textures[0].placement = glm::translate(glm::dmat4(1), dvec3(off));
        scene.textures[0].parameter[0] = scene.textures[0].parameter[1] = 0.1;
        INFO(kind << " " << off);
        CHECK(pattern_at(info, scene, kind == TEXTURE_BRICK ? 0.25 : 0, 0) == Approx(0).margin(1e-6));
      }
  });
}

TEST_CASE("a formula gives a pattern: a number that mixes two colours, a colour, or a height") {
  SceneDescription scene = scenes::line_of_sight({0.3, 5, 0.2}, {0.3, 0, 0.2}, {0, 0, 1});
  const auto add_formula = [&](const std::string& text, std::vector<FormulaParameter> parameters) {
    const int index = add_pattern(scene, TEXTURE_FORMULA, 0.5);
    scene.textures.back().formula =
        std::make_shared<PatternFormula>(PatternFormula{text, std::move(parameters)});
    return index;
  };
  FormulaParameter turns, shift;
  turns.name = "turns", turns.value = {3};
  shift.name = "shift", shift.value = {0.25, 0.5, 0.75};
  const int number = add_formula("t = sin(turns * p.x)\n0.5 + 0.5 * t * cos(p.z)", {turns});
  scene.textures.back().factor = {0.5, 0, 0, 0}, scene.textures.back().offset = {0.25, 0, 0, 1};
  const int color = add_formula("fract(p + shift)", {shift});
  const int bad = add_formula("x = exp(400 * p.x)\nx * x", {});
  const int height = add_formula("0.25 * p.x", {});
  // Balls under the plane have all of the textures, so that the kernels are the same whichever the plane has.
  for (const int texture : {number, color, bad}) {
    scenes::place(scene, SphereShape{0.1}, scenes::add_white(scene),
                  glm::translate(glm::dmat4(1), dvec3(0, -9, 0)));
    scene.materials.back().emission = dvec3(1);
    scene.materials.back().textures.emission = texture;
    scene.materials.back().textures.height = height;
  }
  scenes::place(scene, PlaneShape{}, scenes::add_white(scene));
  MaterialDescription& m = scene.materials.back();
  m.ambient = m.diffuse = dvec3(0);
  m.emission = dvec3(1);
  on_picture_devices([&](const DeviceInfo& info) {
    const auto seen = [&](int texture) {
      m.textures.emission = texture;
      return scenes::pixel_on(info, scene);  // of the point (0.3, 0, 0.2)
    };
    CHECK(seen(number).x ==
          Approx(0.25 + 0.5 * (0.5 + 0.5 * std::sin(3 * 0.6) * std::cos(0.4))).epsilon(1e-4));
    const dvec3 found = seen(color);
    CHECK(found.x == Approx(0.85).epsilon(1e-3));
    CHECK(found.y == Approx(0.5).epsilon(1e-3));
    CHECK(found.z == Approx(0.15).epsilon(1e-3));
    CHECK(std::isfinite(seen(bad).x));
    // As a height of 0.5 on a unit of x, times 0.5: the sun above sees the normal (-0.25, 1, 0).
    m.textures.emission = -1, m.emission = dvec3(0), m.diffuse = dvec3(1);
    m.textures.height = height, m.bump = 0.5;
    LightDescription sun;
    sun.type = LightType::directional;
    sun.direction = {0, -1, 0};
    scene.lights.assign(1, sun);
    CHECK(scenes::pixel_on(info, scene).x == Approx(1 / std::sqrt(1 + 0.25 * 0.25)).epsilon(2e-3));
  });
}

TEST_CASE("a pattern mixes textures, a ramp colours one, and a product is one") {
  SceneDescription scene = white_plane();
  const int stripes = add_pattern(scene, TEXTURE_STRIPES);
  scene.textures[0].parameter[0] = 0.5;
  TextureDescription half;
  half.offset = {0.5, 0.5, 0.5, 1};
  scene.textures.push_back(half);
  const int grey = static_cast<int>(scene.textures.size()) - 1;
  const int mixed = add_pattern(scene, TEXTURE_GRADIENT, 4);
  scene.textures.back().of[0] = grey, scene.textures.back().of[1] = stripes;
  TextureDescription ramp;
  ramp.kind = TEXTURE_RAMP;
  ramp.of[0] = mixed;
  ramp.stops = {{0, {0, 0, 0}}, {0.5, {0.2, 0, 0}}, {1, {1, 0, 0}}};
  scene.textures.push_back(ramp);
  const int colored = static_cast<int>(scene.textures.size()) - 1;
  TextureDescription product;
  product.kind = TEXTURE_PRODUCT;
  product.of[0] = colored, product.of[1] = grey;
  scene.textures.push_back(product);
  const int last = static_cast<int>(scene.textures.size()) - 1;
  const auto of_texture = [&](const DeviceInfo& info, int texture, double x) {
    scene.materials[0].textures.emission = texture;
    return pattern_at(info, scene, x, 0.1);
  };
  on_every_device([&](const DeviceInfo& info) {
    CHECK(of_texture(info, mixed, 1.25) == Approx(0.5 + 1.25 / 4 * (0 - 0.5)).margin(1e-4));
    CHECK(of_texture(info, mixed, 1.75) == Approx(0.5 + 1.75 / 4 * (1 - 0.5)).margin(1e-4));
    const double t = 0.5 + 1.75 / 4 * 0.5, red = 0.2 + (t - 0.5) / 0.5 * 0.8;
    CHECK(of_texture(info, colored, 1.75) == Approx(red).margin(1e-4));
    CHECK(of_texture(info, last, 1.75) == Approx(red / 2).margin(1e-4));
  });
}
