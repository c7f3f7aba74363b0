// Layered materials: every lobe returns at most all light, is reciprocal, and is sampled as its density has
// it; what layers leave for those below is what they do not return.
#include "layer_testing.h"

using namespace sundog;
using namespace sundog::lobes;

TEST_CASE("white layered materials return at most all light at every roughness, and little less") {
  Tester& tester = tester_on(picture_devices().front(), true);
  for (const double roughness : {0.0, 0.1, 0.2, 0.35, 0.5, 1.0})
    for (const Named& one : white_materials(roughness)) {
      tester.set_layers(one.values);
      for (const double cosine : {1.0, 0.7, 0.3, 0.1}) {
        INFO(one.name << " of the roughness " << roughness << " at " << cosine);
        const Material material = layered(one.values).material;
        const double mean = mean_weight(tester.draw(material, 1, at_cosine(cosine), 4 * count));
        CHECK(mean < 1.005);
        CHECK(mean > one.least);
        const double inside =
            mean_weight(tester.draw(material, 1, -at_cosine(cosine), 4 * count));  // no layers there
        CHECK(inside < 1.005);
        CHECK(inside > one.least);
      }
    }
}

TEST_CASE("light takes the same way through layers in both directions") {
  Tester& tester = tester_on(picture_devices().front(), true);
  OpenPbr values = colored();
  const Material material = layered(values).material;
  for (const double anisotropy : {0.0, 0.7}) {
    values.coat_roughness_anisotropy = anisotropy;
    tester.set_layers(values);
    for (const dvec3& a : {at_cosine(0.9), on_sphere(0.5, 0.2), on_sphere(0.15, 0.6)})
      for (const dvec3& b : {on_sphere(0.8, 0.05), on_sphere(0.4, 0.9), on_sphere(0.1, 0.55)}) {
        const dvec3 there = tester.look(material, 1, a, {b})[0].value / b.z,
                    back = tester.look(material, 1, b, {a})[0].value / a.z;
        INFO(a.z << " and " << b.z);
        for (int channel = 0; channel < 3; ++channel)
          CHECK(there[channel] == Approx(back[channel]).epsilon(2e-3));
      }
  }
}

TEST_CASE("samples of layers lie as their density has it") {
  Tester& tester = tester_on(picture_devices().front(), true);
  OpenPbr brushed{.specular_roughness_anisotropy = 0.6, .base_metalness = 1, .specular_roughness = 0.8};
  tester.set_layers(brushed);
  CHECK(chi_squared(tester, layered(brushed).material, 1, at_cosine(0.7)) < 1.5);
  const OpenPbr values = colored();
  tester.set_layers(values);
  CHECK(chi_squared(tester, layered(values).material, 1, at_cosine(0.6)) < 1.5);
  OpenPbr grooved{.base_weight = 0.1, .specular_weight = 0, .coat_roughness = 0.8, .coat_weight = 1};
  grooved.coat_roughness_anisotropy = 0.6, grooved.coat_ior = 2.5;
  tester.set_layers(grooved);
  CHECK(chi_squared(tester, layered(grooved).material, 1, at_cosine(0.7)) < 1.5);
  const OpenPbr velvet{.base_weight = 0.2, .fuzz_weight = 1, .fuzz_roughness = 0.6};
  tester.set_layers(velvet);
  CHECK(chi_squared(tester, layered(velvet).material, 1, at_cosine(0.3)) < 1.5);
  OpenPbr glass = colored();
  glass.transmission_weight = 0.7, glass.specular_roughness = 0.8, glass.base_metalness = 0;
  tester.set_layers(glass);
  CHECK(chi_squared(tester, layered(glass).material, 1.5, at_cosine(0.6)) < 1.5);
  CHECK(chi_squared(tester, layered(glass).material, 1.5, -at_cosine(0.8)) < 1.5);
}

TEST_CASE("what layers leave for those below is what they do not return") {
  Tester& tester = tester_on(picture_devices().front(), true);
  const OpenPbr black{.base_weight = 0, .specular_weight = 0, .specular_roughness = 0.5};
  OpenPbr coat = black, fuzz = black, shine = black;
  coat.coat_weight = 1, coat.coat_roughness = 0.6, coat.coat_ior = 1.8;
  fuzz.fuzz_weight = 1, fuzz.fuzz_roughness = 0.7;
  shine.specular_weight = 1, shine.specular_ior = 1.7, shine.specular_roughness = 0.6;
  const std::pair<u32, OpenPbr> layers[] = {{LAYER_COAT, coat}, {LAYER_FUZZ, fuzz}, {LAYER_SHINE, shine}};
  for (const auto& [row, values] : layers) {
    LayerRows table;
    const Layers made = make_layers(values, {}, table);
    tester.set_layers(values);
    for (const u32 column : {31u, 20u, 10u, 4u}) {
      const double cosine = double(column) / (LAYER_STEPS - 1);
      const Material material = layered(values).material;
      const double left = double(table.values[made.first + row * LAYER_STEPS + column]);
      INFO(row << " at " << cosine);
      CHECK(mean_weight(tester.draw(material, 1, at_cosine(cosine))) == Approx(1 - left).margin(0.01));
      CHECK(mean_value(tester.look(material, 1, at_cosine(cosine), all_directions())) ==
            Approx(1 - left).margin(0.01));
    }
  }
}

TEST_CASE("a coat darkens a matte base as reflections within it do") {
  Tester& tester = tester_on(picture_devices().front(), true);
  const double index = 1.6, albedo = 0.5, turn_back = std::sqrt(1 - 1 / (index * index));
  // The coat's internal reflectance of light from all around: all of it beyond the critical angle.
  double inner = turn_back * turn_back;
  constexpr int steps = 4000;
  for (int i = 0; i < steps; ++i) {
    const double cosine = turn_back + (1 - turn_back) * (i + 0.5) / steps;
    const double outside = std::sqrt(std::max(0.0, 1 - index * index * (1 - cosine * cosine)));
    const double across = (index * cosine - outside) / (index * cosine + outside),
                 along = (cosine - index * outside) / (cosine + index * outside);
    inner += (1 - turn_back) / steps * cosine * (across * across + along * along);
  }
  const double straight = std::pow((index - 1) / (index + 1), 2);
  OpenPbr values{.specular_weight = 0, .coat_ior = index, .base_color = dvec3(albedo), .coat_weight = 1};
  for (const double darkening : {1.0, 0.0, 0.5}) {
    values.coat_darkening = darkening;
    tester.set_layers(values);
    const double factor = std::lerp(1.0, (1 - inner) / (1 - albedo * inner), darkening);
    CHECK(mean_weight(tester.draw(layered(values).material, 1, at_cosine(1), 4 * count)) ==
          Approx(straight + (1 - straight) * albedo * factor).margin(0.005));
  }
}

TEST_CASE("a coat darkens clear glass by next to nothing: what the base lets through is not sent back") {
  Tester& tester = tester_on(picture_devices().front(), true);
  OpenPbr glass{.specular_roughness = 0, .transmission_weight = 1, .coat_weight = 1};
  for (const double roughness : {0.0, 0.3}) {
    glass.coat_roughness = roughness;
    glass.specular_roughness = roughness;
    const auto passed = [&](double darkening, double side) {
      glass.coat_darkening = darkening;
      tester.set_layers(glass);
      const Layered made = layered(glass);
      return mean_weight(tester.draw(made.material, made.index, side * at_cosine(1), 4 * count));
    };
    for (const double side : {1.0, -1.0}) {
      INFO("roughness " << roughness << " from the side " << side);
      CHECK(passed(1, side) == Approx(passed(0, side)).epsilon(0.05));
      CHECK(passed(1, side) > 0.85);
    }
  }
}

TEST_CASE("smooth white glass below a coat or fuzz returns all light, from within too") {
  Tester& tester = tester_on(picture_devices().front(), true);
  const OpenPbr glass{.specular_roughness = 0, .transmission_weight = 1};
  OpenPbr coated = glass, fuzzy = glass;
  coated.coat_weight = 1;
  fuzzy.fuzz_weight = 1;
  for (const OpenPbr& values : {coated, fuzzy}) {
    tester.set_layers(values);
    const Layered made = layered(values);
    for (const double cosine : {1.0, 0.8, 0.5}) {
      INFO((values.coat_weight > 0 ? "coat at " : "fuzz at ") << cosine);
      for (const double side : {1.0, -1.0})
        CHECK(mean_weight(tester.draw(made.material, made.index, side * at_cosine(cosine), 4 * count)) ==
              Approx(1).margin(0.005));
    }
  }
}
