// Layered materials whose metalness, roughness, coat's weight or reflected colour come from textures: between
// the steps of their grid too they return at most all light, are reciprocal and sampled as their density has
// it, and a texture of one value is the number.
#include <nlohmann/json.hpp>

#include "layer_testing.h"
#include "scene/json/parse.h"
#include "scene/read/scene_reader.h"
#include "scenes.h"

using namespace sundog;
using namespace sundog::lobes;

namespace {

/// Places on the grid and between its steps.
constexpr double roughnesses[] = {0, 0.1, 0.2, 0.33, 0.5, 0.77, 1};

/// Factors on a coat's weight, on the steps of the grids and between them.
constexpr double coats[] = {0, 0.09, 0.4, 0.62, 0.83, 1};

double greatest_of(const dvec3& c) { return std::max({c.x, c.y, c.z}); }

/// A texture of the coat's weight, and one of the roughness where `rough`.
MaterialTextures coat_texture(bool rough) {
  MaterialTextures textures;
  textures.coat = 0;
  if (rough) textures.roughness = 0;
  return textures;
}

/// How far apart two fields of lobes are, over the sum of the first; their densities agree.
double apart_from(const std::vector<Lobe>& wanted, const std::vector<Lobe>& found) {
  double apart = 0, sum = 0;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    apart += greatest_of(glm::abs(found[i].value - wanted[i].value));
    sum += greatest_of(wanted[i].value);
    CHECK(found[i].density == Approx(wanted[i].density).epsilon(0.01).margin(1e-3));
  }
  return apart / sum;
}

/// Light takes the same way in both directions, and samples lie as their density has it.
void check_both_ways(Tester& tester, const Material& material) {
  for (const dvec3& a : {at_cosine(0.9), on_sphere(0.15, 0.6)})
    for (const dvec3& b : {on_sphere(0.8, 0.05), on_sphere(0.4, 0.9)}) {
      const dvec3 there = tester.look(material, 1, a, {b})[0].value / b.z,
                  back = tester.look(material, 1, b, {a})[0].value / a.z;
      INFO(a.z << " and " << b.z);
      for (int channel = 0; channel < 3; ++channel)
        CHECK(there[channel] == Approx(back[channel]).epsilon(2e-3));
    }
  CHECK(chi_squared(tester, material, 1, at_cosine(0.6)) < 1.5);
}

/// A ball on a grey plane; `values` are keys of its material.
SceneDescription lit_room(const std::string& integrator, const std::string& values) {
  nlohmann::json document =
      parse_json(R"({"camera": {"position": [0, 1.2, 4], "target": [0, 0.4, 0], "fov": 40},
    "image": {"width": 48, "height": 36, "background": [0.6, 0.7, 0.8]},
    "render": {"samples": 64, "max_depth": 4},
    "lights": [{"type": "sphere", "position": [2, 3, 2], "radius": 0.4, "intensity": 4}],
    "textures": {"half": {"type": "checker", "colors": [[0.6, 0.6, 0.6], [0.6, 0.6, 0.6]]},
      "rough": {"type": "checker", "colors": [[0.3, 0.3, 0.3], [0.3, 0.3, 0.3]]},
      "clear": {"type": "checker", "colors": [[0.9, 0.9, 0.9], [0.9, 0.9, 0.9]]}},
    "objects": [{"type": "sphere", "radius": 0.7, "center": [0, 0.7, 0], "material": "m"},
      {"type": "plane", "material": "floor"}]})",
                 "test.json");
  document["render"]["integrator"] = integrator;
  document["materials"]["floor"] = {{"color", {0.5, 0.5, 0.5}}};
  document["materials"]["m"] =
      parse_json(R"({"type": "openpbr", "base_color": [0.9, 0.6, 0.3], )" + values + "}", "test.json");
  if (integrator == "path") {  // under the floor: with it paths of all pairs have the same two kernels
    document["materials"]["glass"] =
        parse_json(R"({"type": "openpbr", "specular_ior": 1.2, "transmission_weight": 0.9})", "test.json");
    document["objects"].push_back(parse_json(
        R"({"type": "sphere", "radius": 0.1, "center": [0, -9, 0], "material": "glass"})", "test.json"));
  }
  if (document["materials"]["m"]["base_metalness"].is_string()) {  // under the floor, for the same reason
    document["materials"]["coated"] =
        parse_json(R"({"type": "openpbr", "coat_weight": "half"})", "test.json");
    document["objects"].push_back(parse_json(
        R"({"type": "sphere", "radius": 0.1, "center": [3, -9, 0], "material": "coated"})", "test.json"));
  }
  const JsonContext context{"test.json"};
  return read_scene(JsonValue(document, context));
}

/// Means of squares of four by four pixels: less noise.
std::vector<double> blocks(const Image& image) {
  const int columns = image.width / 4;
  std::vector<double> sums(static_cast<std::size_t>(columns * (image.height / 4) * 3));
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int k = 0; k < 3; ++k)
        sums[static_cast<std::size_t>((y / 4 * columns + x / 4) * 3 + k)] +=
            double(image.data[static_cast<std::size_t>((y * image.width + x) * 4 + k)]) / 16;
  return sums;
}

}  // namespace

TEST_CASE(
    "white materials with textures of roughness or metalness return at most all light, and little less") {
  Tester& tester = tester_on(picture_devices().front(), true, true);
  for (const Named& one : white_materials(0.3)) {
    tester.set_layers(one.values);  // of all that is done here this takes longest
    const Material material = layered(one.values).material;
    for (const double roughness : roughnesses)
      for (const double cosine : {1.0, 0.7, 0.3, 0.1}) {
        INFO(one.name << " of the roughness " << roughness << " at " << cosine);
        tester.set_base(one.values.base_metalness, roughness);
        for (const double side : {1.0, -1.0}) {
          const double mean = mean_weight(tester.draw(material, 1, side * at_cosine(cosine), 4 * count));
          CHECK(mean < 1.005);
          CHECK(mean > one.least - 0.005);  // scaled down for the midst of steps
        }
      }
    for (const double metalness : {0.0, 0.35, 1.0}) {
      INFO(one.name << " of the metalness " << metalness);
      tester.set_base(metalness, 0.4);
      const double mean = mean_weight(tester.draw(material, 1, at_cosine(0.5), 4 * count));
      CHECK(mean < 1.005);
      CHECK(mean > one.least);
    }
  }
}

TEST_CASE("light takes the same way in both directions where textures give metalness and roughness") {
  Tester& tester = tester_on(picture_devices().front(), true, true);
  const OpenPbr values = colored();
  tester.set_layers(values);
  const Material material = layered(values).material;
  for (const double roughness : {0.23, 0.5})
    for (const dvec3& a : {at_cosine(0.9), on_sphere(0.5, 0.2), on_sphere(0.15, 0.6)})
      for (const dvec3& b : {on_sphere(0.8, 0.05), on_sphere(0.4, 0.9)}) {
        tester.set_base(0.6, roughness);
        const dvec3 there = tester.look(material, 1, a, {b})[0].value / b.z,
                    back = tester.look(material, 1, b, {a})[0].value / a.z;
        INFO(roughness << ": " << a.z << " and " << b.z);
        for (int channel = 0; channel < 3; ++channel)
          CHECK(there[channel] == Approx(back[channel]).epsilon(2e-3));
      }
}

TEST_CASE("samples lie as their density has it where textures give metalness and roughness") {
  Tester& tester = tester_on(picture_devices().front(), true, true);
  OpenPbr values = colored();
  tester.set_layers(values);
  for (const double roughness : {0.43, 0.9}) {
    tester.set_base(0.7, roughness);
    CHECK(chi_squared(tester, layered(values).material, 1, at_cosine(0.6)) < 1.5);
  }
  values.transmission_weight = 0.7, values.base_metalness = 0;
  tester.set_layers(values);
  tester.set_base(0, 0.83, 0.7);
  CHECK(chi_squared(tester, layered(values).material, 1.5, at_cosine(0.6)) < 1.5);
  CHECK(chi_squared(tester, layered(values).material, 1.5, -at_cosine(0.8)) < 1.5);
}

TEST_CASE("a texture of one value gives the lobes of the number") {
  Tester &plain = tester_on(picture_devices().front(), true),
         &mapped = tester_on(picture_devices().front(), true, true);
  for (const double roughness : {0.25, 0.4, 0.65}) {
    OpenPbr values = colored();
    values.specular_roughness = roughness;
    plain.set_layers(values);
    mapped.set_layers(values);
    const Material material = layered(values).material;
    const auto wanted = plain.look(material, 1, at_cosine(0.6), all_directions()),
               found = mapped.look(material, 1, at_cosine(0.6), all_directions());
    INFO("roughness " << roughness);
    CHECK(apart_from(wanted, found) < 0.004);
  }
}

TEST_CASE("white materials with textures of the coat's weight return at most all light, and little less") {
  Tester& tester = tester_on(picture_devices().front(), true, true);
  for (const bool rough : {false, true})
    for (const Named& one : white_materials(0.3)) {
      if (one.values.coat_weight == 0) continue;
      tester.set_layers(one.values, coat_texture(rough));
      const Material material = layered(one.values).material;
      for (const double coat : coats) {
        tester.set_base(one.values.base_metalness, one.values.specular_roughness, 0, coat);
        for (const double cosine : {1.0, 0.7, 0.3, 0.1}) {
          INFO(one.name << (rough ? ", rough" : "") << ", coat " << coat << " at " << cosine);
          const double mean = mean_weight(tester.draw(material, 1, at_cosine(cosine), 4 * count));
          CHECK(mean < 1.005);
          CHECK(mean > one.least - 0.005);
        }
      }
    }
}

TEST_CASE(
    "light takes the same way in both directions, and samples lie as their density has it, below a coat of "
    "which a texture gives the weight") {
  Tester& tester = tester_on(picture_devices().front(), true, true);
  const OpenPbr values = colored();
  const Material material = layered(values).material;
  for (const bool rough : {false, true}) {
    tester.set_layers(values, coat_texture(rough));
    tester.set_base(0.3, 0.5, 0, 0.43);
    check_both_ways(tester, material);
  }
}

TEST_CASE("a texture of one value of the coat's weight gives the lobes of the number") {
  Tester &plain = tester_on(picture_devices().front(), true),
         &mapped = tester_on(picture_devices().front(), true, true);
  OpenPbr values = colored();
  values.coat_weight = 1;
  const Material material = layered(values).material;
  std::vector<std::vector<Lobe>> wanted;
  for (const double coat : coats) {
    OpenPbr number = values;
    number.coat_weight = coat;
    plain.set_layers(number);
    wanted.push_back(plain.look(material, 1, at_cosine(0.6), all_directions()));
  }
  for (const bool rough : {false, true}) {
    mapped.set_layers(values, coat_texture(rough));
    for (std::size_t i = 0; i < std::size(coats); ++i) {
      const double coat = coats[i];
      mapped.set_base(values.base_metalness, values.specular_roughness, 0, coat);
      INFO("coat " << coat << (rough ? ", rough" : ""));
      const double apart = apart_from(wanted[i], mapped.look(material, 1, at_cosine(0.6), all_directions()));
      CHECK(apart < (!rough && (coat == 0 || coat == 1) ? 2e-5 : 0.003));
    }
  }
}

TEST_CASE("glass below a coat of which a texture gives the weight has what passes the number") {
  Tester &plain = tester_on(picture_devices().front(), true),
         &mapped = tester_on(picture_devices().front(), true, true);
  OpenPbr glass{.specular_roughness = 0, .transmission_weight = 1, .coat_weight = 0.4};
  glass.coat_color = {0.9, 0.5, 0.2};
  plain.set_layers(glass);
  glass.coat_weight = 1;
  mapped.set_layers(glass, coat_texture(false));
  mapped.set_base(0, 0, 1, 0.4);
  const Layered surface = layered(glass);
  for (const double side : {1.0, -1.0}) {
    const auto mean = [&](Tester& tester) {
      dvec3 sum(0);
      for (const Lobe& one : tester.draw(surface.material, surface.index, side * at_cosine(0.8)))
        sum += one.value / double(count);
      return sum;
    };
    const dvec3 wanted = mean(plain), found = mean(mapped);
    for (int channel = 0; channel < 3; ++channel)
      CHECK(found[channel] == Approx(wanted[channel]).epsilon(0.005));
  }
}

TEST_CASE("what a texture takes from the reflection of white materials comes back from below") {
  Tester& tester = tester_on(picture_devices().front(), true, true);
  for (const Named& one : white_materials(0.3)) {
    tester.set_layers(one.values);
    const Material material = layered(one.values).material;
    for (const double tint : {0.0, 0.45})
      for (const double cosine : {1.0, 0.5, 0.1}) {
        tester.set_base(one.values.base_metalness, one.values.specular_roughness);
        tester.set_tint(dvec3(tint));
        INFO(one.name << " of the tint " << tint << " at " << cosine);
        const double mean = mean_weight(tester.draw(material, 1, at_cosine(cosine), 4 * count));
        CHECK(mean < 1.005);
        CHECK(mean > one.least - 0.005);
      }
  }
}

TEST_CASE("a dielectric of which a texture takes all reflection is its matte ground") {
  Tester &plain = tester_on(picture_devices().front(), true),
         &mapped = tester_on(picture_devices().front(), true, true);
  OpenPbr values{.base_color = {0.8, 0.5, 0.2}, .specular_roughness = 0.4};
  mapped.set_layers(values);
  mapped.set_tint(dvec3(0));
  values.specular_weight = 0;
  plain.set_layers(values);
  const Material material = layered(values).material;
  const auto wanted = plain.look(material, 1, at_cosine(0.6), all_directions()),
             found = mapped.look(material, 1, at_cosine(0.6), all_directions());
  CHECK(apart_from(wanted, found) < 1e-4);
}

TEST_CASE(
    "light takes the same way in both directions, and samples lie as their density has it, where a texture "
    "gives the reflected colour") {
  Tester& tester = tester_on(picture_devices().front(), true, true);
  const OpenPbr values = colored();
  tester.set_layers(values);
  tester.set_base(0.3, 0.5);
  tester.set_tint({0.8, 0.4, 0.1});
  const Material material = layered(values).material;
  check_both_ways(tester, material);
}

TEST_CASE("a texture of one value gives the picture of the number") {
  const std::string coat = R"(, "coat_roughness": 0.2, "coat_weight": 0.6)",
                    coat_map = R"(, "coat_roughness": 0.2, "coat_weight": "half")",
                    ior = R"(, "specular_ior": 1.2, "transmission_weight": )";
  struct Pair {
    std::string number, texture;
  };
  const Pair pairs[] = {{"", ""}, {coat, coat_map}, {ior + "0.9", ior + R"("clear")"}};
  for (const std::string integrator : {"path", "whitted"})
    for (const Pair& pair : pairs) {
      const auto render = [&](const std::string& values) {
        return blocks(scenes::render_on(test_devices().front(), lit_room(integrator, values)).image);
      };
      const std::vector<double> wanted = render(R"("base_metalness": 0.6, "specular_roughness": 0.3)" +
                                                pair.number),
                                found = render(R"("base_metalness": "half", "specular_roughness": "rough")" +
                                               pair.texture);
      double worst = 0;
      for (std::size_t i = 0; i < wanted.size(); ++i)
        worst = std::max(worst, std::abs(found[i] - wanted[i]) / (0.05 + wanted[i]));
      INFO(integrator << pair.texture);
      CHECK(worst < 0.02);
    }
}
