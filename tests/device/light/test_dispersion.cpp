// Dispersion: prisms against Snell's law, what must stay white or keep its colour, and guided paths.
#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <vector>

#include "catch.h"
#include "compile/compiled_scene.h"
#include "devices.h"
#include "same_bits.h"
#include "scene/lamps.h"
#include "scene/spectra/cie.h"
#include "scenes.h"

using namespace sundog;
using glm::dvec3;

namespace {

constexpr double pi = std::numbers::pi;

/// A prism of 60 degrees about the z axis, its edge up, with sides of length 2.
Mesh prism_mesh() {
  Mesh mesh;
  const float half = 1, top = std::sqrt(3.0f) / 2;
  for (const float z : {-2.0f, 2.0f}) {
    mesh.positions.push_back({0, top, z});
    mesh.positions.push_back({-half, -top, z});
    mesh.positions.push_back({half, -top, z});
  }
  mesh.triangles = {{0, 2, 1}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3}, {0, 3, 5}, {0, 5, 2}, {1, 2, 5}, {1, 5, 4}};
  mesh.source_vertex_count = 6;
  return mesh;
}

/// Clear glass of that substance.
int add_glass(SceneDescription& scene, const char* substance) {
  const auto dispersion = find_substance(substance);
  REQUIRE(dispersion);
  const int glass = scenes::add_dielectric(scene, index_at(*dispersion, 1, line_d));
  scene.media.back().dispersion = *dispersion;
  return glass;
}

/// A small picture by paths of a prism, a slab and a lamp. The view is narrow and goes from position to
/// target.
struct Places {
  dvec3 position, target, prism{0, -50, 0}, slab{0, -60, 0}, lamp{0, -70, 0};
};
SceneDescription prism_scene(const Places& places, const char* substance = "SF10") {
  SceneDescription scene = scenes::line_of_sight(places.position, places.target);
  scene.lights.clear();
  scene.image.width = scene.image.height = 8;
  scene.render.integrator = "path";
  scene.render.samples = 64;
  scene.render.max_depth = 64;
  scene.render.sampler = SAMPLER_SOBOL;
  scene.meshes.push_back(prism_mesh());
  const int glass = add_glass(scene, substance);
  scenes::place(scene, MeshShape{0}, glass, glm::translate(glm::dmat4(1), places.prism));
  scenes::place(scene, BoxShape{{5, 5, 0.5}}, glass, glm::translate(glm::dmat4(1), places.slab));
  LightDescription lamp;
  lamp.type = LightType::rectangle;
  lamp.position = places.lamp;
  lamp.size = {0.05, 3};
  scene.lights.push_back(lamp);
  add_lamps(scene);
  return scene;
}

dvec3 mean_on(const DeviceInfo& device, const SceneDescription& scene) {
  const Image image = scenes::render_on(device, scene).image;
  dvec3 sum(0);
  for (std::size_t i = 0; i < image.data.size(); i += 4)
    sum += dvec3(image.data[i], image.data[i + 1], image.data[i + 2]);
  return sum / (double(image.data.size()) / 4);
}

void check_color(const dvec3& found, const dvec3& expected, double within) {
  INFO(found.x << " " << found.y << " " << found.z);
  for (int c = 0; c < 3; ++c) CHECK(std::abs(found[c] - expected[c]) < within);
}

// Rays through a prism of 60 degrees: in at the angle .x to the first face's normal, of the row .y. Out: the
// deviation in degrees, or 0 of what is reflected.
const char* const prism_kernel = R"(
#include "lib/shade/bsdf.cl"
#include "plain/shade/specular.cl"
__kernel void run(__global const Material* materials, __global const Medium* media, __global const float* spectra,
                  __global const float4* in, __global float* out, u32 count) {
  const u32 i = get_global_id(0);
  if (i >= count) return;
  const Scene scene = {.materials = materials, .media = media, .spectra = spectra};
  const REAL3 n = real3(-1.0f, 0.0f, 0.0f);  // of the first face; the second's is 120 degrees on
  const REAL3 d = real3(cos(in[i].x), -sin(in[i].x), 0.0f);
  Bsdfs bsdf = {n, n, n, n, 0, (int)materials[0].flags, 0, 1, in[i].y};
  Interfaces interface = make_interface(&scene, &bsdf, negate3(d), ALL_LANES);
  const REAL3 inside = transmitted_direction(&bsdf, &interface, negate3(d), ALL_LANES);
  bsdf.side = real3(-0.5f, 0.8660254f, 0.0f);
  bsdf.ns = bsdf.side;
  bsdf.before = 1;
  bsdf.after = 0;
  interface = make_interface(&scene, &bsdf, negate3(inside), ALL_LANES);
  const REAL3 behind = transmitted_direction(&bsdf, &interface, negate3(inside), ALL_LANES);
  out[i] = interface.cos_t > 0.0f ? acos(clamp(dot3(d, behind), -1.0f, 1.0f)) * (180.0f / M_PI_F) : 0.0f;
}
)";

/// The least deviation by the program above, in degrees.
double least_deviation(Device& device, const CompiledScene& flat, double wavelength) {
  auto kernel =
      build_text(device, prism_kernel,
                 {{"TILE_W", "1"}, {"TILE_H", "1"}, {"LANES", "1"}, {"WIDE_VECTORS", "0"}})
          .kernel<Buffer<Material>, Buffer<Medium>, Buffer<float>, Buffer<float4>, Buffer<float>, u32>("run");
  std::vector<float4> in;
  for (int i = 0; i < 4096; ++i)
    in.push_back({static_cast<float>((30 + 55 * i / 4096.0) * pi / 180),
                  static_cast<float>((wavelength - 380) / 5), 0, 0});
  const auto material = std::ranges::find(flat.materials, u32{MATERIAL_DIELECTRIC}, &Material::kind);
  const auto out = device.make<float>(in.size());
  device.run(kernel, {.x = in.size()}, device.upload<Material>({&*material, 1}),
             device.upload<Medium>(flat.media.rows()), device.upload<float>(flat.spectra.rows()),
             device.upload<float4>(in), out, static_cast<u32>(in.size()));
  std::vector<float> deviations(in.size());
  device.read(out, std::span<float>(deviations));
  device.finish();
  std::erase(deviations, 0.0f);
  REQUIRE(!deviations.empty());
  return static_cast<double>(*std::ranges::min_element(deviations));
}

/// The mean row of a channel's light.
double middle_row(const Image& image, std::size_t channel) {
  double sum = 0, weighed = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const double value = std::max(0.0f, image.data[4 * std::size_t(y * image.width + x) + channel]);
      sum += value;
      weighed += value * y;
    }
  REQUIRE(sum > 0);
  return weighed / sum;
}

/// The least deviation of SF10, weighed by what each wavelength adds to a channel.
double bend_of_channel(int channel) {
  double sum = 0, weighed = 0;
  for (double l = 380; l <= 780; l += 1) {
    const double weight = std::max(0.0, rgb_weight(l)[channel]);
    sum += weight;
    weighed += weight * 2 * std::asin(index_at(*find_substance("SF10"), 1, l) / 2);
  }
  return weighed / sum;
}

}  // namespace

TEST_CASE("Dispersion: a prism's least deviation follows from the index at each wavelength") {
  on_every_device([&](const DeviceInfo& info) {
    Device device(info);
    for (const char* substance : {"BK7", "SF10"}) {
      const SceneDescription scene = prism_scene({{0, 0, 5}, {0, 0, 0}}, substance);
      const CompiledScene flat = compile(scene);
      for (const double line : {line_F, line_d, line_C}) {
        const double n = index_at(*find_substance(substance), 1, line);
        INFO(substance << " at " << line);
        CHECK(std::abs(least_deviation(device, flat, line) - (2 * std::asin(n / 2) * 180 / pi - 60)) < 0.01);
      }
    }
  });
}

TEST_CASE(
    "Dispersion: through a prism a slit has its colours in their order, as far apart as Snell's law has "
    "them") {
  const double deviation = 2 * std::asin(1.72825 / 2) - pi / 3, slant = deviation / 2;
  const dvec3 in(std::cos(slant), std::sin(slant), 0), out(std::cos(slant), -std::sin(slant), 0);
  SceneDescription scene =
      prism_scene({.position = -6.0 * in, .target = {0, 0, 0}, .prism = {0, 0, 0}, .lamp = 30.0 * out});
  scene.camera.up = {0, 0, 1};
  scene.camera.up = glm::cross(dvec3(0, 0, 1), in);
  scene.camera.fov = 14;
  scene.image.width = 4;
  scene.image.height = 56;
  scene.lights.front().direction = -out;
  scene.lights.front().up = {0, 0, 1};
  scene.lights.front().size = {0.3, 20};
  scene.objects.pop_back();
  add_lamps(scene);
  const Image image = scenes::render_on(test_devices().front(), scene).image;
  const double red = middle_row(image, 0), green = middle_row(image, 1), blue = middle_row(image, 2);
  INFO(red << " " << green << " " << blue);
  CHECK((blue + 2 < green && green + 2 < red));  // row 0 is up, away from the base: the way blue comes
  // Nearer to the prism than the lamp, the camera turns less than the light: 30 of 36.
  const double rows = (bend_of_channel(2) - bend_of_channel(0)) * 180 / pi * 56 / 14 * 30 / 36;
  CHECK(red - blue == Approx(rows).epsilon(0.08));
}

TEST_CASE(
    "Dispersion: white stays white through a slab and a prism, and a colour of the sky stays that colour") {
  for (const dvec3& sky : {dvec3(1), dvec3(0.2, 0.7, 0.1), dvec3(0, 0.3, 1)})
    for (const bool slab : {true, false}) {
      SceneDescription scene = prism_scene({{2.4, 1.1, 3}, {0, 0, 0}});
      scene.objects[slab ? 1 : 0].world_from_object = glm::dmat4(1);
      scene.image.background_bottom = scene.image.background_top = sky;
      scene.render.samples = 1024;
      INFO((slab ? "slab" : "prism"));
      check_color(mean_on(test_devices().front(), scene), sky, 0.006);
    }
}

TEST_CASE("Dispersion: surfaces under white light have the colours that the scene gives them") {
  const dvec3 color(0.8, 0.3, 0.05);
  SceneDescription scene = prism_scene({.position = {0, 0.6, 3}, .target = {0, 0, 0}, .lamp = {0, 0.8, 0}});
  scene.lights.front().size = {1.2, 0.7};
  scene.lights.front().up = {0, 0, -1};
  scene.objects.pop_back();
  add_lamps(scene);
  scene.render.samples = 256;
  const int matte = scenes::add_white(scene);
  scene.materials.back().diffuse = color;
  scenes::place(scene, BoxShape{{9, 0.5, 9}}, matte, glm::translate(glm::dmat4(1), {0, -0.5, 0}));
  const double x = 0.6 / 0.8, y = 0.35 / 0.8, rx = std::sqrt(1 + x * x), ry = std::sqrt(1 + y * y);
  const double seen = 4 / (2 * pi) * (x / rx * std::atan(y / rx) + y / ry * std::atan(x / ry));
  check_color(mean_on(test_devices().front(), scene), color * seen, 0.006);
}

TEST_CASE("Dispersion: a picture has the same bits for every work-group and tile") {
  SceneDescription scene =
      prism_scene({.position = {0.4, 1.2, 6}, .target = {0, 0, 0}, .prism = {0, 0, 0}, .lamp = {0, 3, 0}});
  scene.camera.fov = 40;
  scene.image.width = 24;
  scene.image.height = 18;
  scene.render.samples = 4;
  scene.image.background_top = {0.3, 0.5, 0.9};
  const DeviceInfo device = test_devices().front();
  const Image reference = scenes::render_on(device, scene).image;
  for (const std::size_t size : {1u, 3u, 8u}) {
    RenderOptions options;
    options.work_group = {WorkGroup::Kind::fixed, size, 1};
    CHECK(same_bits(scenes::render_on(device, scene, options).image, reference));
  }
  RenderOptions options;
  options.tile = 8;
  CHECK(same_bits(scenes::render_on(device, scene, options).image, reference));
  scene.render.sampling.progressive = true;
  CHECK(same_bits(scenes::render_on(device, scene).image, reference));
}

TEST_CASE("Dispersion: only paths carry wavelengths, and only where some medium disperses") {
  SceneDescription scene = prism_scene({{0, 0, 5}, {0, 0, 0}});
  const CompiledScene paths = compile(scene);
  CHECK(paths.features.dispersion);
  CHECK(paths.spectra.size() == (SPECTRUM_COLUMNS + 1) * SPECTRUM_ROWS);  // one substance
  CHECK(paths.media[0].spectrum == NO_SPECTRUM);
  CHECK(paths.media[1].spectrum == SPECTRUM_COLUMNS * SPECTRUM_ROWS);
  for (const auto& [low, wavelength] :
       {std::pair{WAVELENGTH_LOW, SPECTRUM_FIRST}, {WAVELENGTH_HIGH, SPECTRUM_LAST}})
    CHECK(std::tanh((wavelength - WAVELENGTH_MIDDLE) / WAVELENGTH_SCALE) == Approx(low));
  SceneDescription classic = scene;
  classic.render.integrator = "whitted";
  CHECK_FALSE(compile(classic).features.dispersion);
  CHECK(compile(classic).spectra.empty());
  CHECK(compile(classic).media[1].absorption.w == Approx(1.72825));
  for (MediumDescription& medium : scene.media) medium.dispersion = {};
  CHECK_FALSE(compile(scene).features.dispersion);
}

TEST_CASE("guided paths find the same light, from lamps too that are chosen") {
  const double a = 0.6, b = 0.35, h = 0.8, albedo = 0.6;
  const double x = a / h, y = b / h, rx = std::sqrt(1 + x * x), ry = std::sqrt(1 + y * y);
  const double seen = 4 / (2 * pi) * (x / rx * std::atan(y / rx) + y / ry * std::atan(x / ry));
  for (const u32 strategy : {STRATEGY_MIS, STRATEGY_LIGHTS, STRATEGY_SURFACES}) {
    SceneDescription scene = scenes::line_of_sight({0, 0.6, 3}, {0, 0, 0});
    scene.lights.clear();
    scene.image.width = scene.image.height = 8;
    scene.render.integrator = "path";
    scene.render.samples = 128;
    scene.render.light_strategy = strategy;
    // One beside the lamp, one about its middle, one about the surface.
    scene.render.guides = {{{1, 0.8, 0}, 0.2}, {{0, 0.8, 0}, 0.3}, {{0, 0.2, 0}, 0.5}};
    LightDescription lamp;
    lamp.type = LightType::rectangle;
    lamp.position = {0, h, 0};
    lamp.up = {0, 0, -1};
    lamp.size = {2 * a, 2 * b};
    scene.lights.push_back(lamp);
    add_lamps(scene);
    const int matte = scenes::add_white(scene);
    scene.materials.back().diffuse = dvec3(albedo);
    scenes::place(scene, PlaneShape{}, matte);
    INFO("strategy " << strategy);
    check_color(mean_on(test_devices().front(), scene), dvec3(albedo * seen), 0.006);
  }
}
