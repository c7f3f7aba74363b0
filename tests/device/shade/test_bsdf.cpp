// sample_lobes() and the sampler behind it: means over many directions have closed forms, perfect reflection
// and refraction their laws.
#include <cmath>
#include <glm/glm.hpp>
#include <numbers>
#include <vector>

#include "catch.h"
#include "devices.h"
#include "shared/scene.h"
#include "surface_text.h"

using namespace sundog;
using glm::dvec3;

namespace {

constexpr double pi = std::numbers::pi;
constexpr u32 count = 1u << 15;

const std::string draw_kernel = surface_text + R"(
#include "lib/core/sampler_lanes.cl"
// One material, ns = ng = +z, the viewer at the cosine `cosine` to it in the plane y = 0; behind it the medium 1. Eight floats
// a sample: wi, density, weight, whether it is specular.
__kernel void draw(__global const Material* materials, __global const Medium* media, __global float* out, float cosine,
                   u32 count) {
  const u32 i = get_global_id(0);
  if (i >= count) return;
  const Scene scene = {.materials = materials, .media = media};
  const REAL3 n = real3(0.0f, 0.0f, 1.0f), wo = real3(-sqrt(1.0f - cosine * cosine), 0.0f, cosine);
  const Bsdfs bsdf = make_surface(materials, n, 0, 1);
  const LaneSamples at = {7, 9, (int)i};
  const FourNumbers u = chosen_lanes(&at, 0, true, true);
  const LobeSets lobes = make_lobes(&scene, &bsdf, wo, ALL_LANES);
  const BsdfSamples s = sample_lobes(&scene, &bsdf, &lobes, wo, u.x, u.y, u.z, ALL_LANES);
  __global float* to = out + 8u * i;
  to[0] = s.wi.x; to[1] = s.wi.y; to[2] = s.wi.z; to[3] = s.pdf;
  to[4] = s.weight.x; to[5] = s.weight.y; to[6] = s.weight.z; to[7] = s.specular ? 1.0f : 0.0f;
}
)";

struct Drawn {
  dvec3 wi, weight;
  double density;
  bool specular;
};

std::vector<Drawn> draw(Device& device, const Material& material, double cosine, float index = 1) {
  const KernelDefines one_lane{{"TILE_W", "1"}, {"TILE_H", "1"}, {"LANES", "1"}, {"WIDE_VECTORS", "0"}};
  auto kernel = build_text(device, draw_kernel, one_lane)
                    .kernel<Buffer<Material>, Buffer<Medium>, Buffer<float>, float, u32>("draw");
  std::vector<Medium> media(2);
  media[0].absorption.w = 1;
  media[1].absorption.w = index;
  const auto materials = device.upload<Material>(std::vector{material});
  const auto table = device.upload<Medium>(media);
  const auto out = device.make<float>(8 * count);
  device.run(kernel, {.x = count}, materials, table, out, static_cast<float>(cosine), count);
  std::vector<float> values(8 * count);
  device.read(out, std::span<float>(values));
  std::vector<Drawn> drawn;
  for (u32 i = 0; i < count; ++i) {
    const float* v = values.data() + 8 * std::size_t{i};
    drawn.push_back({{v[0], v[1], v[2]}, {v[4], v[5], v[6]}, v[3], v[7] != 0});
  }
  return drawn;
}

/// The mean of the weights, each times the power `moment` of its direction's cosine to the normal.
dvec3 mean_weight(const std::vector<Drawn>& drawn, int moment = 0) {
  dvec3 sum(0);
  for (const Drawn& one : drawn) sum += one.weight * std::pow(one.wi.z, moment);
  return sum / double(drawn.size());
}

}  // namespace

TEST_CASE("a matte surface's samples return kd, two thirds of it by the cosine") {
  Material matte{};
  matte.diffuse = {0.8f, 0.5f, 0.2f, 0};
  on_every_device([&](const DeviceInfo& info) {
    Device device(info);
    const std::vector<Drawn> drawn = draw(device, matte, 0.6);
    for (const Drawn& one : drawn) {
      REQUIRE(glm::length(one.wi) == Approx(1).epsilon(1e-5));
      REQUIRE(one.density == Approx(one.wi.z / pi).epsilon(1e-4));
      REQUIRE_FALSE(one.specular);
    }
    CHECK(mean_weight(drawn).x == Approx(0.8).epsilon(1e-4));  // every weight is kd
    CHECK(mean_weight(drawn).z == Approx(0.2).epsilon(1e-4));
    CHECK(mean_weight(drawn, 1).x == Approx(0.8 * 2 / 3).epsilon(0.01));
  });
}

TEST_CASE("samples of highlights return their integrals over the hemisphere") {
  const double exponent = 20, ks = 0.5, kd = 0.25;
  for (const bool blinn : {false, true}) {
    Material shiny{};
    shiny.diffuse = {float(kd), float(kd), float(kd), 0};
    shiny.specular = {float(ks), float(ks), float(ks), float(exponent)};
    shiny.flags = blinn ? MATERIAL_BLINN : 0;
    // Seen along the normal: of Phong's the integral of cos^e, of Blinn's that of cos^e of half the angle,
    // over pi.
    const double lobe =
        blinn ? 8 * ks / (exponent + 2) * (1 - std::pow(2, -(exponent + 2) / 2)) : 2 * ks / (exponent + 1);
    for (const DeviceInfo& info : test_devices())
      DYNAMIC_SECTION(info.label() << (blinn ? ", Blinn" : ", Phong")) {
        Device device(info);
        CHECK(mean_weight(draw(device, shiny, 1)).y ==
              Approx(kd + lobe).epsilon(0.02));  // four standard deviations
        // How Phong's lie about the normal: of c^e, weighed by c^e once more.
        Material black = shiny;
        black.diffuse = {0, 0, 0, 0};
        if (!blinn)
          CHECK(mean_weight(draw(device, black, 1), 20).y ==
                Approx(lobe * (exponent + 1) / (2 * exponent + 1)).epsilon(0.01));
      }
  }
}

TEST_CASE("samples of a dielectric are reflected with Fresnel's probability, else refracted by Snell's law") {
  const double n = 1.5, cos_i = 0.6, sin_i = 0.8, cos_t = std::sqrt(1 - sin_i * sin_i / (n * n));
  const double parallel = (n * cos_i - cos_t) / (n * cos_i + cos_t),
               across = (cos_i - n * cos_t) / (cos_i + n * cos_t);
  const double fresnel = 0.5 * (parallel * parallel + across * across);
  Material glass{};
  glass.kind = MATERIAL_DIELECTRIC;
  glass.flags = MATERIAL_REFLECTS | MATERIAL_TRANSMITS;
  glass.reflection = glass.transmission = {1, 1, 1, 0};
  on_every_device([&](const DeviceInfo& info) {
    Device device(info);
    const std::vector<Drawn> drawn = draw(device, glass, cos_i, float(n));
    double reflected = 0;
    for (const Drawn& one : drawn) {
      REQUIRE(one.specular);
      REQUIRE(one.weight.x == Approx(1).epsilon(1e-4));
      const bool mirrored = one.wi.z > 0;
      reflected += mirrored;
      const dvec3 expected = mirrored ? dvec3(sin_i, 0, cos_i) : dvec3(sin_i / n, 0, -cos_t);
      REQUIRE(glm::distance(one.wi, expected) < 1e-5);
      REQUIRE(one.density == Approx(mirrored ? fresnel : 1 - fresnel).epsilon(1e-3));
    }
    CHECK(reflected / count == Approx(fresnel).epsilon(0.1));
  });
}
