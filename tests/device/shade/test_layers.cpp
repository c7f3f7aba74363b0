// Layered materials: every lobe returns at most all light, is reciprocal, and is sampled as its density has
// it; what layers leave for those below is what they do not return.
#include "lobe_testing.h"
#include "scene/description.h"

using namespace sundog;
using namespace sundog::lobes;

namespace {

/// The material of `values` as the kernels have it, of the index of refraction `index` where light goes
/// through.
struct Layered {
  Material material{};
  double index = 1;
};

Layered layered(const OpenPbr& values) {
  MaterialDescription description;
  MediumDescription inside;
  Layered to;
  const bool through = set_openpbr(values, description, inside);
  to.material.flags = MATERIAL_LAYERED | MATERIAL_REFLECTS | (through ? MATERIAL_TRANSMITS : MATERIAL_THIN);
  to.material.kind = through ? MATERIAL_DIELECTRIC : MATERIAL_PHONG;
  const auto packed = [](const dvec3& c, double w) {
    return float4{float(c.x), float(c.y), float(c.z), float(w)};
  };
  to.material.diffuse = packed(description.diffuse, 0);
  to.material.reflection =
      packed(description.reflection, values.specular_roughness * values.specular_roughness);
  to.material.transmission = packed(description.transmission, 0);
  if (through) to.index = inside.ior;
  return to;
}

/// White materials, each with another lobe on top.
struct Named {
  const char* name;
  OpenPbr values;
  double least = 0.9;  // of the light that it returns
};

std::vector<Named> white_materials(double roughness) {
  const dvec3 white(1);
  OpenPbr metal{.base_color = white, .base_metalness = 1, .specular_roughness = roughness};
  OpenPbr brushed = metal, plastic{.base_color = white, .specular_roughness = roughness};
  brushed.specular_roughness_anisotropy = 0.8;
  OpenPbr clay = plastic, painted = plastic, lacquered = metal, velvet = plastic, film = plastic,
          all = plastic;
  clay.base_diffuse_roughness = 1;
  painted.coat_weight = lacquered.coat_weight = 1;
  painted.coat_roughness = roughness, lacquered.coat_roughness = 0.3;
  velvet.fuzz_weight = 1, velvet.fuzz_roughness = roughness;
  film.thin_film_weight = 1;
  all.coat_weight = all.fuzz_weight = all.thin_film_weight = 0.7;
  all.base_metalness = 0.4, all.coat_roughness = 0.2, all.specular_roughness_anisotropy = 0.5;
  return {{"metal", metal, 0.98},  {"brushed", brushed, 0.9},  {"plastic", plastic, 0.98},
          {"clay", clay, 0.9},     {"painted", painted, 0.95}, {"lacquered", lacquered},
          {"velvet", velvet, 0.9}, {"film", film, 0.95},       {"all", all, 0.82}};
}

OpenPbr colored() {
  OpenPbr v{.base_color = {0.8, 0.5, 0.2}, .base_metalness = 0.3, .base_diffuse_roughness = 0.6};
  v.specular_roughness = 0.5, v.specular_roughness_anisotropy = 0.6;
  v.coat_weight = 0.8, v.coat_roughness = 0.4, v.coat_color = {0.9, 0.8, 0.6};
  v.fuzz_weight = 0.6, v.fuzz_roughness = 0.6;
  v.thin_film_weight = 0.5, v.thin_film_thickness = 0.35;
  return v;
}

/// What a surface returns by sums over even directions, and by samples.
double mean_value(const std::vector<Lobe>& field) {
  double sum = 0;
  for (const Lobe& one : field) sum += one.value.x;
  return sum * 4 / double(field.size());
}

}  // namespace

TEST_CASE("white layered materials return at most all light at every roughness, and little less") {
  Tester tester(picture_devices().front(), true);
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
  Tester tester(picture_devices().front(), true);
  const OpenPbr values = colored();
  tester.set_layers(values);
  const Material material = layered(values).material;
  for (const dvec3& a : {at_cosine(0.9), on_sphere(0.5, 0.2), on_sphere(0.15, 0.6)})
    for (const dvec3& b : {on_sphere(0.8, 0.05), on_sphere(0.4, 0.9), on_sphere(0.1, 0.55)}) {
      const dvec3 there = tester.look(material, 1, a, {b})[0].value / b.z,
                  back = tester.look(material, 1, b, {a})[0].value / a.z;
      INFO(a.z << " and " << b.z);
      for (int channel = 0; channel < 3; ++channel)
        CHECK(there[channel] == Approx(back[channel]).epsilon(2e-3));
    }
}

TEST_CASE("samples of layers lie as their density has it") {
  Tester tester(picture_devices().front(), true);
  OpenPbr brushed{.base_metalness = 1, .specular_roughness = 0.8, .specular_roughness_anisotropy = 0.6};
  tester.set_layers(brushed);
  CHECK(chi_squared(tester, layered(brushed).material, 1, at_cosine(0.7)) < 1.5);
  const OpenPbr values = colored();
  tester.set_layers(values);
  CHECK(chi_squared(tester, layered(values).material, 1, at_cosine(0.6)) < 1.5);
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
  Tester tester(picture_devices().front(), true);
  const OpenPbr black{.base_weight = 0, .specular_weight = 0, .specular_roughness = 0.5};
  OpenPbr coat = black, fuzz = black, shine = black;
  coat.coat_weight = 1, coat.coat_roughness = 0.6, coat.coat_ior = 1.8;
  fuzz.fuzz_weight = 1, fuzz.fuzz_roughness = 0.7;
  shine.specular_weight = 1, shine.specular_ior = 1.7, shine.specular_roughness = 0.6;
  const std::pair<u32, OpenPbr> layers[] = {{LAYER_COAT, coat}, {LAYER_FUZZ, fuzz}, {LAYER_SHINE, shine}};
  for (const auto& [row, values] : layers) {
    std::vector<float> table;
    const Layers made = make_layers(values, table);
    tester.set_layers(values);
    for (const u32 column : {31u, 20u, 10u, 4u}) {
      const double cosine = double(column) / (LAYER_STEPS - 1);
      const Material material = layered(values).material;
      const double left = double(table[made.first + row * LAYER_STEPS + column]);
      INFO(row << " at " << cosine);
      CHECK(mean_weight(tester.draw(material, 1, at_cosine(cosine))) == Approx(1 - left).margin(0.01));
      CHECK(mean_value(tester.look(material, 1, at_cosine(cosine), all_directions())) ==
            Approx(1 - left).margin(0.01));
    }
  }
}

TEST_CASE("a coat darkens a matte base as reflections within it do") {
  Tester tester(picture_devices().front(), true);
  const double index = 1.6, albedo = 0.5, turn_back = std::sqrt(1 - 1 / (index * index));
  // What the inside of the coat sends back of light from all around, with all of it beyond the critical
  // angle.
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
  OpenPbr values{.base_color = dvec3(albedo), .specular_weight = 0, .coat_weight = 1, .coat_ior = index};
  for (const double darkening : {1.0, 0.0, 0.5}) {
    values.coat_darkening = darkening;
    tester.set_layers(values);
    const double factor = std::lerp(1.0, (1 - inner) / (1 - albedo * inner), darkening);
    CHECK(mean_weight(tester.draw(layered(values).material, 1, at_cosine(1), 4 * count)) ==
          Approx(straight + (1 - straight) * albedo * factor).margin(0.005));
  }
}

TEST_CASE("a coat darkens clear glass by next to nothing: what the base lets through is not sent back") {
  Tester tester(picture_devices().front(), true);
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
