// Layers of glTF's materials as their extensions say: in a white surrounding.
#include <cmath>
#include <numbers>

#include "catch.h"
#include "devices.h"
#include "gltf_tiles.h"
#include "scene/load.h"
#include "scenes.h"

using namespace sundog;
using nlohmann::json;

namespace {

json material(double roughness, const json& extensions, const json& color = {0, 0, 0, 1}) {
  return {{"pbrMetallicRoughness",
           {{"baseColorFactor", color}, {"metallicFactor", 0}, {"roughnessFactor", roughness}}},
          {"extensions", extensions}};
}

/// The light that the materials return along the normal in a white surrounding and of lights. `depth`: of
/// their squares along z, below 0 for mirrored ones.
std::vector<double> returned(const DeviceInfo& device, const std::vector<json>& materials,
                             const std::string& integrator, double depth = 1,
                             const json& lights = json::array()) {
  GltfTiles tiles;
  for (std::size_t i = 0; i < materials.size(); ++i)
    tiles.add(double(i) - double(materials.size() - 1) / 2, 0, depth, materials[i]);
  const TemporaryFolder folder;
  tiles.write(folder);
  const json document = {
      {"camera",
       {{"position", {0, 4000, 0}},
        {"target", {0, 0, 0}},
        {"up", {0, 0, -1}},
        {"fov", 2 * std::atan(0.5 / 4000) * 180 / std::numbers::pi}}},
      {"image", {{"width", 8 * materials.size()}, {"height", 8}}},
      {"render", {{"integrator", integrator}, {"samples", 512}, {"max_depth", 3}, {"cutoff", 0}}},
      {"environment", {{"type", "gradient"}, {"bottom", {1, 1, 1}}, {"top", {1, 1, 1}}}},
      {"lights", lights},
      {"objects", {{{"type", "model"}, {"file", "tiles.gltf"}}}}};
  const Image image =
      scenes::render_on(device, load_scene(folder.write("tiles.json", document.dump()))).image;
  std::vector<double> sums(materials.size());
  for (std::size_t i = 0; i < materials.size(); ++i)
    for (std::size_t y = 2; y < 6; ++y)
      for (std::size_t x = 2; x < 6; ++x)
        sums[i] += double(image.data[(y * std::size_t(image.width) + 8 * i + x) * 4]) / 16;
  return sums;
}

json clearcoat(double factor, double roughness = 0) {
  return {
      {"KHR_materials_clearcoat", {{"clearcoatFactor", factor}, {"clearcoatRoughnessFactor", roughness}}}};
}

json sheen(int texture) {
  json values = {{"sheenColorFactor", {1, 1, 1}}, {"sheenRoughnessFactor", 0.6}};
  if (texture >= 0) values["sheenColorTexture"] = {{"index", texture}};
  return {{"KHR_materials_sheen", values}};
}

}  // namespace

TEST_CASE("a clear coat of glTF leaves its base's highlight, whatever the coat's weight and roughness") {
  const std::vector<json> materials = {material(0.44, json::object()), material(0.44, clearcoat(0.5)),
                                       material(0.44, clearcoat(1)), material(0.2, json::object()),
                                       material(0.2, clearcoat(1, 0.8))};
  on_picture_devices([&](const DeviceInfo& device) {
    const std::vector<double> seen = returned(device, materials, "path");
    const double f = 0.04;
    CHECK(seen[0] == Approx(f).epsilon(0.1));  // the base's own
    CHECK(seen[1] == Approx(f / 2 + (1 - f / 2) * seen[0]).epsilon(0.03));
    CHECK(seen[2] == Approx(f + (1 - f) * seen[0]).epsilon(0.03));
    CHECK(seen[4] > 1.5 * seen[3]);
    const std::vector<double> by_whitted = returned(device, materials, "whitted");
    for (const std::size_t coated : {1u, 2u, 4u})
      CHECK(by_whitted[coated] == Approx(seen[coated]).epsilon(0.1));
  });
}

TEST_CASE("the color of glTF's sheen is that of its texture") {
  const json blue = {0.02, 0.05, 0.2, 1};
  const std::vector<json> materials = {material(1, json::object(), blue), material(1, sheen(-1), blue),
                                       material(1, sheen(0), blue), material(1, sheen(1), blue)};
  for (const char* integrator : {"whitted", "path"})
    on_picture_devices([&](const DeviceInfo& device) {
      INFO(integrator);
      const std::vector<double> seen = returned(device, materials, integrator);
      CHECK(seen[1] > 1.3 * seen[0]);
      CHECK(seen[2] == Approx(seen[1]).epsilon(0.02));
      if (integrator == std::string("path"))  // whitted has no layers without the extension
        CHECK(seen[3] == Approx(seen[0]).epsilon(0.02));
      CHECK(seen[3] < 0.8 * seen[1]);
    });
}

TEST_CASE("glTF's anisotropy is mirrored with its surface") {
  const json brushed = material(
      0.4, {{"KHR_materials_anisotropy", {{"anisotropyStrength", 0.9}, {"anisotropyRotation", 0.7}}}});
  for (const char* integrator : {"whitted", "path"})
    on_picture_devices([&](const DeviceInfo& device) {
      const auto lit = [&](double depth, double z) {
        const json sun = {{{"type", "directional"}, {"direction", {0.5, -0.8, z}}, {"intensity", 50}}};
        return returned(device, {brushed}, integrator, depth, sun)[0];
      };
      const double plain = lit(1, 0.4);
      CHECK(lit(-1, -0.4) == Approx(plain).epsilon(0.01));
      CHECK(std::abs(lit(-1, 0.4) / plain - 1) > 0.2);
    });
}
