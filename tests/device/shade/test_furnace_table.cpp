// Every material at every roughness with both integrators, in one picture: tiles on a floor. In a white
// surrounding, and under one lamp that mirrors see too, nothing returns more light than arrives. (-s prints
// the tables.)
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <numbers>

#include "catch.h"
#include "devices.h"
#include "gltf_tiles.h"
#include "scene/load.h"
#include "scenes.h"

using namespace sundog;
using nlohmann::json;

namespace {

constexpr std::array roughnesses = {0.0, 0.1, 0.3, 0.5, 0.7, 1.0};

/// A material by its roughness; `alike`: both integrators mean the same by it.
struct Row {
  std::string name;
  bool of_gltf, alike;
  std::function<json(double)> material;
};

json openpbr(const json& values) {
  json material = {{"type", "openpbr"}, {"base_color", {1, 1, 1}}};
  material.update(values);
  return material;
}

json gltf(double metallic, double roughness, const json& extensions = json::object(), bool texture = false) {
  json values = {{"metallicFactor", metallic}, {"roughnessFactor", roughness}};
  if (texture) values["metallicRoughnessTexture"] = {{"index", 0}};
  return {{"pbrMetallicRoughness", values}, {"extensions", extensions}};
}

std::vector<Row> rows() {
  const json black = {{"ambient", 0}, {"diffuse", 0}, {"specular", 0}};
  const auto with = [](json base, const json& more) {
    base.update(more);
    return base;
  };
  const auto covered_pane = [](const std::string& layer, double r) {
    return openpbr({{"transmission_weight", 1},
                    {"geometry_thin_walled", true},
                    {"specular_roughness", r},
                    {layer + "_roughness", r},
                    {layer + "_weight", 1}});
  };
  const json coat = {{"KHR_materials_clearcoat", {{"clearcoatFactor", 1}}}},
             sheen = {{"KHR_materials_sheen", {{"sheenColorFactor", {1, 1, 1}}}}},
             passing = {{"KHR_materials_transmission", {{"transmissionFactor", 1}}}};
  return {
      {"matte", false, true, [](double) { return json{{"color", {1, 1, 1}}, {"diffuse", 1}}; }},
      {"phong", false, true,
       [](double r) {
         return json{{"diffuse", 0.5},
                     {"specular", {{"coefficient", 0.2}, {"exponent", std::pow(std::max(r, 0.1), -4)}}}};
       }},
      {"mirror", false, true, [=](double) { return with(black, {{"reflection", 0.9}}); }},
      {"rough mirror", false, true,
       [=](double r) { return with(black, {{"reflection", 1}, {"roughness", r}}); }},
      {"thin wall", false, true,
       [](double) { return json{{"type", "dielectric"}, {"ior", 1.5}, {"thin_walled", true}}; }},
      {"metal", false, false,
       [](double r) { return openpbr({{"base_metalness", 1}, {"specular_roughness", r}}); }},
      {"half metal", false, false,
       [](double r) { return openpbr({{"base_metalness", 0.5}, {"specular_roughness", r}}); }},
      {"brushed metal", false, false,
       [](double r) {
         return openpbr(
             {{"base_metalness", 1}, {"specular_roughness", r}, {"specular_roughness_anisotropy", 0.8}});
       }},
      {"plastic", false, false, [](double r) { return openpbr({{"specular_roughness", r}}); }},
      {"film", false, false,
       [](double r) { return openpbr({{"thin_film_weight", 1}, {"specular_roughness", r}}); }},
      {"coat", false, false, [](double r) { return openpbr({{"coat_weight", 1}, {"coat_roughness", r}}); }},
      {"coated metal", false, false,
       [](double r) { return openpbr({{"base_metalness", 1}, {"coat_weight", 1}, {"coat_roughness", r}}); }},
      {"coat on black", false, false,
       [](double r) {
         return openpbr(
             {{"base_color", {0, 0, 0}}, {"specular_weight", 0}, {"coat_weight", 1}, {"coat_roughness", r}});
       }},
      {"fuzz", false, false,
       [](double r) {
         return openpbr({{"fuzz_weight", 1}, {"fuzz_roughness", r}, {"specular_roughness", r}});
       }},
      {"pane", false, false,
       [](double r) {
         return openpbr(
             {{"transmission_weight", 1}, {"geometry_thin_walled", true}, {"specular_roughness", r}});
       }},
      {"coated pane", false, false, [=](double r) { return covered_pane("coat", r); }},
      {"fuzzy pane", false, false, [=](double r) { return covered_pane("fuzz", r); }},
      {"glTF metal", true, false, [](double r) { return gltf(1, r); }},
      {"glTF half metal", true, false, [](double r) { return gltf(0.5, r); }},
      {"glTF plastic", true, false, [](double r) { return gltf(0, r); }},
      {"glTF coat", true, false, [=](double r) { return gltf(0, r, coat); }},
      {"glTF sheen", true, false, [=](double r) { return gltf(0, r, sheen); }},
      {"glTF pane", true, false, [=](double r) { return gltf(0, r, passing); }},
      {"glTF metal, textured", true, false, [](double r) { return gltf(1, r, json::object(), true); }},
      {"glTF half metal, textured", true, false, [](double r) { return gltf(0.5, r, json::object(), true); }},
  };
}

constexpr int tile = 4;  // pixels

/// The floor, seen at the cosine to its normal so that tiles are squares, with `light` added to the document.
SceneDescription floor_of_tiles(const std::vector<Row>& all, double cosine, const std::string& integrator,
                                const json& light) {
  constexpr double away = 4000;
  const double sine = std::sqrt(1 - cosine * cosine), depth = 1 / cosine;
  const auto lines = roughnesses.size();
  json document = {
      {"camera",
       {{"position", {0, away * cosine, away * sine}},
        {"target", {0, 0, 0}},
        {"fov", 2 * std::atan(double(lines) / 2 / away) * 180 / std::numbers::pi}}},
      {"image", {{"width", tile * all.size()}, {"height", tile * lines}}},
      {"render", {{"integrator", integrator}, {"samples", 512}, {"cutoff", 0}, {"max_depth", 4}}},
      {"objects", {{{"type", "model"}, {"file", "tiles.gltf"}}}}};
  document.update(light);
  GltfTiles tiles;
  for (std::size_t column = 0; column < all.size(); ++column)
    for (std::size_t line = 0; line < lines; ++line) {
      const double x = double(column) - double(all.size() - 1) / 2,
                   z = (double(line) - double(lines - 1) / 2) * depth;
      const json material = all[column].material(roughnesses[line]);
      if (all[column].of_gltf) {
        tiles.add(x, z, depth, material);
        continue;
      }
      const std::string name = fmt::format("{} {}", all[column].name, roughnesses[line]);
      document["materials"][name] = material;
      document["objects"].push_back(
          {{"type", "rectangle"}, {"size", {1, depth}}, {"center", {x, 0, z}}, {"material", name}});
    }
  const TemporaryFolder folder;
  tiles.write(folder);
  return load_scene(folder.write("floor.json", document.dump()));
}

using Table = std::vector<std::array<double, roughnesses.size()>>;

/// The light that the middles of the tiles return, a row a material; printed.
Table returned(const DeviceInfo& device, const std::vector<Row>& all, double cosine,
               const std::string& integrator, const json& light) {
  const Image image = scenes::render_on(device, floor_of_tiles(all, cosine, integrator, light)).image;
  Table table(all.size());
  std::string text = fmt::format("{} at the cosine {}, roughness 0 to 1:\n", integrator, cosine);
  for (std::size_t column = 0; column < all.size(); ++column) {
    text += fmt::format("{:26}", all[column].name);
    for (std::size_t line = 0; line < roughnesses.size(); ++line) {
      double sum = 0;
      for (const std::size_t y : {line * tile + 1, line * tile + 2})
        for (const std::size_t x : {column * tile + 1, column * tile + 2})
          sum += double(image.data[(y * std::size_t(image.width) + x) * 4 + 1]) / 4;
      table[column][line] = sum;
      text += fmt::format(" {:6.3f}", sum);
    }
    text += '\n';
  }
  SUCCEED(text);
  return table;
}

}  // namespace

TEST_CASE("no material returns more light than arrives, with either integrator, at any roughness") {
  const std::vector<Row> all = rows();
  const double cosine = GENERATE(0.9, 0.25);
  const bool lamp = GENERATE(false, true);
  const json bright = {{"type", "gradient"}, {"bottom", {1, 1, 1}}, {"top", {1, 1, 1}}, {"samples", 8}};
  const double sine = std::sqrt(1 - cosine * cosine);
  const json disk = {{"type", "sphere"},
                     {"position", {0, 1000 * cosine, -1000 * sine}},
                     {"radius", 500},
                     {"intensity", 1},
                     {"samples", 4}};
  const json light = lamp ? json{{"lights", {disk}}} : json{{"environment", bright}};
  const DeviceInfo& device = picture_devices().front();
  const Table by_whitted = returned(device, all, cosine, "whitted", light),
              by_path = returned(device, all, cosine, "path", light);
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t line = 0; line < roughnesses.size(); ++line) {
      INFO(all[i].name << " of roughness " << roughnesses[line] << (lamp ? ", lamp" : ", furnace"));
      CHECK(by_whitted[i][line] < 1.01);
      CHECK(by_path[i][line] < 1.01);
      // whitted gives light that is lost between facets back to the lobe, path by the light's direction too.
      if (all[i].alike && !(lamp && all[i].name == "rough mirror"))
        CHECK(by_whitted[i][line] == Approx(by_path[i][line]).epsilon(0.01).margin(0.003));
    }
}

TEST_CASE(
    "under a lamp that no ray meets layered materials have their whole highlight with both integrators") {
  std::vector<Row> all = rows();
  std::erase_if(all, [](const Row& row) {
    return row.of_gltf || row.name.ends_with("pane") || row.name == "rough mirror";
  });
  const json sun = {{"lights", {{{"type", "directional"}, {"direction", {0, -0.8, -0.6}}}}}};
  const DeviceInfo& device = picture_devices().front();
  const Table by_whitted = returned(device, all, 0.7, "whitted", sun),
              by_path = returned(device, all, 0.7, "path", sun);
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t line = 0; line < roughnesses.size(); ++line) {
      INFO(all[i].name << " of roughness " << roughnesses[line]);
      CHECK(by_whitted[i][line] == Approx(by_path[i][line]).epsilon(0.01).margin(1e-3));
    }
}
