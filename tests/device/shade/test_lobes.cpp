// Lobes as integrators see them that follow one ray on: in a furnace they return what they should, densities
// are those of the samples, and viewer and light may change places. First those of every row of
// kernels/shared/lobes.h, then rough ones.
#include <functional>
#include <optional>

#include "layer_testing.h"
#include "shared/lobes.h"
#include "single_albedo.h"

using namespace sundog;
using namespace sundog::lobes;

namespace {

/// At most all light but for the noise of the mean, and little less.
void returns_all(const std::vector<Lobe>& drawn) {
  double squares = 0;
  const double mean = mean_weight(drawn);
  for (const Lobe& one : drawn) squares += (one.value.x - mean) * (one.value.x - mean);
  const double noise = std::sqrt(squares) / double(drawn.size());
  CHECK(mean < 1.001 + noise);
  CHECK(mean > 0.985 - noise);
}

/// A lobe that is drawn, with the index of refraction behind the surface and the direction to the viewer.
struct Drawn {
  Material material;
  double index;
  dvec3 wo;
};

/// The weights of many samples on the first device. The other devices draw fewer, which are the first
/// device's.
std::vector<Lobe> many_drawn(const DeviceInfo& info, const Drawn& from, u32 draws) {
  Tester& first = tester_on(test_devices().front());
  if (info.label() == test_devices().front().label())
    return first.draw(from.material, from.index, from.wo, draws);
  const std::vector<Lobe> wanted = first.draw(from.material, from.index, from.wo),
                          found = tester_on(info).draw(from.material, from.index, from.wo);
  std::size_t apart = 0;
  for (std::size_t i = 0; i < found.size(); ++i)
    apart += glm::distance(found[i].wi, wanted[i].wi) > 1e-2 ||
             std::abs(found[i].value.x - wanted[i].value.x) > 1e-2;
  CHECK(apart < found.size() / 500);  // by rounding, where another lobe is chosen
  CHECK(mean_weight(found) == Approx(mean_weight(wanted)).epsilon(1e-3));
  return {};
}

/// A material whose light is that of one lobe, or of the perfect ones together.
struct LobeCase {
  Material material{};
  double index = 1;
  std::optional<OpenPbr> layers = std::nullopt;
  double apart = 1e-4;           // from its albedo, as a part of it, is what it returns
  bool with_the_cosine = false;  // its value times the cosine stays if viewer and light change places
};

LobeCase case_of_mirror() { return {.material = rough_metal(0, 0.7f)}; }
LobeCase case_of_refraction() { return {.material = rough_glass(0), .index = 1.5}; }
LobeCase case_of_ggx() { return {.material = rough_metal(0.6, 0.9f), .apart = 0.06}; }
LobeCase case_of_layered() {
  const OpenPbr plastic{.base_color = dvec3(0.8), .specular_roughness = 0.5};
  return {.material = layered(plastic).material, .layers = plastic, .apart = 0.06};
}
LobeCase case_of_diffuse() {
  LobeCase matte;
  matte.material.diffuse = {0.6f, 0.6f, 0.6f, 0};
  return matte;
}
LobeCase case_of_highlight() {
  LobeCase shiny{.apart = 0.05, .with_the_cosine = true};
  shiny.material.specular = {0.5f, 0.5f, 0.5f, 20};
  shiny.material.flags = MATERIAL_SHINES;
  return shiny;
}

/// Calls body(tester, case) for each row of a list: one without a case does not compile.
#define TEST_LOBE(feature, name, flags)                       \
  if (const LobeCase one = case_of_##name(); true) {          \
    INFO(#name);                                              \
    Tester& tester = tester_on(info, one.layers.has_value()); \
    if (one.layers) tester.set_layers(*one.layers);           \
    body(tester, one);                                        \
  }
using LobeTest = std::function<void(Tester&, const LobeCase&)>;
void each_perfect_lobe(const DeviceInfo& info, const LobeTest& body) { PERFECT_LOBES(TEST_LOBE) }
void each_scattering_lobe(const DeviceInfo& info, const LobeTest& body) { SCATTERING_LOBES(TEST_LOBE) }
#undef TEST_LOBE

}  // namespace

TEST_CASE("every lobe returns its albedo of white surroundings, and no more light than arrives") {
  on_picture_devices([](const DeviceInfo& info) {
    const auto returns_albedo = [](Tester& tester, const LobeCase& one) {
      for (const double cosine : {1.0, 0.8, 0.5}) {
        INFO("at " << cosine);
        const std::vector<Lobe> drawn = tester.draw(one.material, one.index, at_cosine(cosine), 4 * count);
        CHECK(drawn[0].albedo > 0);
        CHECK(mean_weight(drawn) == Approx(drawn[0].albedo).epsilon(one.apart));
        CHECK(mean_weight(drawn) < 1.001);
      }
    };
    each_perfect_lobe(info, returns_albedo);
    each_scattering_lobe(info, returns_albedo);
  });
}

TEST_CASE("every scattering lobe returns the same if viewer and light change places") {
  on_picture_devices([](const DeviceInfo& info) {
    each_scattering_lobe(info, [](Tester& tester, const LobeCase& one) {
      const auto value = [&](const dvec3& wo, const dvec3& wi) {
        const double whole = tester.look(one.material, one.index, wo, {wi})[0].value.x;
        return one.with_the_cosine ? whole : whole / wi.z;
      };
      for (const dvec3& a : {at_cosine(0.9), at_cosine(0.4)})
        for (const dvec3& b : {on_sphere(0.8, 0.05), on_sphere(0.5, 0.02)}) {
          CHECK(value(a, b) > 0);
          CHECK(value(a, b) == Approx(value(b, a)).epsilon(2e-3));
        }
    });
  });
}

TEST_CASE("every perfect lobe sends light back along its way, the same part of it") {
  on_picture_devices([](const DeviceInfo& info) {
    each_perfect_lobe(info, [](Tester& tester, const LobeCase& one) {
      const dvec3 wo = at_cosine(0.6);
      for (const Lobe& there : tester.draw(one.material, one.index, wo, 64)) {
        REQUIRE(there.specular);
        const auto returns = [&](const Lobe& back) {
          return glm::distance(back.wi, wo) < 1e-4 &&
                 back.value.x * back.density == Approx(there.value.x * there.density).epsilon(1e-3);
        };
        CHECK(std::ranges::any_of(tester.draw(one.material, one.index, there.wi, 256), returns));
      }
    });
  });
}

TEST_CASE("samples of every lobe lie as their density has it") {
  on_picture_devices([](const DeviceInfo& info) {
    each_scattering_lobe(info, [](Tester& tester, const LobeCase& one) {
      CHECK(chi_squared(tester, one.material, one.index, at_cosine(0.7)) < 1.5);
    });
    each_perfect_lobe(info, [](Tester& tester, const LobeCase& one) {
      const std::vector<Lobe> drawn = tester.draw(one.material, one.index, at_cosine(0.3));
      for (const bool above : {true, false}) {
        const auto is_there = [&](const Lobe& sample) { return (sample.wi.z > 0) == above; };
        const auto found = std::ranges::count_if(drawn, is_there);
        const auto first = std::ranges::find_if(drawn, is_there);
        if (first != drawn.end()) CHECK(double(found) / count == Approx(first->density).margin(2e-3));
      }
    });
  });
}

TEST_CASE("a white rough mirror returns all light and no more, a grey one no more than smooth") {
  on_every_device([](const DeviceInfo& info) {
    Tester& tester = tester_on(info);
    for (const double roughness : {0.02, 0.1, 0.2, 0.3, 0.45, 0.6, 0.8, 1.0})
      for (const double cosine : {1.0, 0.6, 0.2, 0.04}) {
        INFO(roughness << " at " << cosine);
        returns_all(tester.draw(rough_metal(roughness), 1, at_cosine(cosine)));
        const double grey = mean_weight(tester.draw(rough_metal(roughness, 0.5f), 1, at_cosine(cosine)));
        CHECK(grey < 0.506);
        CHECK(grey > 0.3);
      }
  });
}

TEST_CASE("white rough glass returns all light and no more at every roughness and index, from either side") {
  on_every_device([](const DeviceInfo& info) {
    for (const double index : {1.05, 1.2, 1.45, 3.5})
      for (const double roughness : {0.03, 0.1, 0.2, 0.45, 1.0})
        for (const double cosine : {0.9, 0.2, -0.9, -0.4}) {
          INFO(index << ", " << roughness << " at " << cosine);
          const dvec3 wo = cosine > 0 ? at_cosine(cosine) : -at_cosine(-cosine);
          const auto drawn = many_drawn(info, {rough_glass(roughness), index, wo}, 16 * count);
          if (!drawn.empty()) returns_all(drawn);
        }
    Material tinted = rough_glass(0.8);
    tinted.transmission = {0.5f, 0.5f, 0.5f, 0};
    const double mean = mean_weight(tester_on(info).draw(tinted, 1.5, at_cosine(0.7)));
    CHECK(mean < 0.55);
    CHECK(mean > 0.4);
  });
}

TEST_CASE("samples of rough lobes lie as their density has it") {
  Material both = rough_glass(0.7), coated = rough_metal(0.6, 0.5f);
  both.diffuse = {0.4f, 0.4f, 0.4f, 0};
  coated.diffuse = {0.3f, 0.3f, 0.3f, 0};
  coated.specular = {0.3f, 0.3f, 0.3f, 12};
  on_every_device([&](const DeviceInfo& info) {
    Tester& tester = tester_on(info);
    CHECK(chi_squared(tester, rough_metal(0.7), 1, at_cosine(0.7)) < 1.5);
    CHECK(chi_squared(tester, coated, 1, at_cosine(0.5)) < 1.5);
    CHECK(chi_squared(tester, rough_glass(0.8), 1.5, at_cosine(0.7)) < 1.5);
    CHECK(chi_squared(tester, rough_glass(0.8), 1.5, -at_cosine(0.8)) < 1.5);
    CHECK(chi_squared(tester, both, 1.33, at_cosine(0.6)) < 1.5);
  });
}

TEST_CASE("light takes the same way through rough surfaces in both directions") {
  const dvec3 o = at_cosine(0.8), above = on_sphere(0.35, 0.1), below = on_sphere(-0.7, 0.05);
  const double index = 1.5;
  on_every_device([&](const DeviceInfo& info) {
    Tester& tester = tester_on(info);
    const auto value = [&](const Material& material, const dvec3& wo, const dvec3& wi) {
      return tester.look(material, index, wo, {wi})[0].value.x / std::abs(wi.z);
    };
    for (const double roughness : {0.4, 0.7, 1.0}) {
      const Material metal = rough_metal(roughness, 0.7f), glass = rough_glass(roughness);
      CHECK(value(metal, o, above) == Approx(value(metal, above, o)).epsilon(1e-3));
      CHECK(value(glass, o, above) == Approx(value(glass, above, o)).epsilon(1e-3));
      CHECK(value(glass, o, below) > 0);
      // Veach 1997, equation 5.14: of radiance over the squared index.
      CHECK(value(glass, o, below) / (index * index) == Approx(value(glass, below, o)).epsilon(1e-3));
    }
  });
}

TEST_CASE("rough surfaces that scatter once lose the light that meets two facets, by quadrature") {
  on_every_device([](const DeviceInfo& info) {
    Tester& tester = tester_on(info);
    for (const double roughness : {0.4472, 0.7, 1.0})
      for (const double cosine : {1.0, 0.6, 0.2}) {
        INFO(roughness << " at " << cosine);
        const double alpha = roughness * roughness;
        Material metal = rough_metal(roughness), glass = rough_glass(roughness);
        metal.flags |= MATERIAL_SCATTERS_ONCE;
        glass.flags |= MATERIAL_SCATTERS_ONCE;
        CHECK(mean_weight(tester.draw(metal, 1, at_cosine(cosine), 4 * count)) ==
              Approx(light_met_once(cosine, alpha, 0).reflected).epsilon(0.003));
        const OnceLight through = light_met_once(cosine, alpha, 1.5);
        CHECK(mean_weight(tester.draw(glass, 1.5, at_cosine(cosine), 16 * count)) ==
              Approx(through.reflected + through.transmitted).epsilon(0.005));
      }
    // Less than what gives it back, which the furnaces above see.
    CHECK(light_met_once(0.6, 1, 0).reflected < 0.7);
    CHECK(light_met_once(0.6, 1, 1.5).reflected + light_met_once(0.6, 1, 1.5).transmitted < 0.95);
  });
}

TEST_CASE("the lobe of metal that scatters once is the distribution times its masking") {
  const double alpha = 0.2, color = 0.75, cosine = 0.7;
  const dvec3 o = at_cosine(cosine);
  on_every_device([&](const DeviceInfo& info) {
    Tester& tester = tester_on(info);
    Material metal = rough_metal(std::sqrt(alpha), float(color));
    metal.flags |= MATERIAL_SCATTERS_ONCE;
    for (const dvec3& wi : {on_sphere(0.7, 0), on_sphere(0.5, 0.02), on_sphere(0.9, 0.9)}) {
      const dvec3 h = glm::normalize(o + wi);
      const double width = h.z * h.z * (alpha * alpha - 1) + 1;
      const double distribution = alpha * alpha / (pi * width * width);
      const double masking = 1 / (1 + smith_of(cosine, alpha) + smith_of(wi.z, alpha));
      CHECK(tester.look(metal, 1, o, {wi})[0].value.x ==
            Approx(pi * color * distribution * masking / (4 * cosine)).epsilon(1e-3));
    }
  });
}
