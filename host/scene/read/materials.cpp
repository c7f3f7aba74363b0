// Media and materials.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/names.h"
#include "scene/read/parts.h"

namespace sundog {

namespace {

/// What colours a surface: one colour, or two in a checkerboard.
struct Pattern {
  dvec3 even{1}, odd{1};
};

constexpr Range ior_range{.low = 0.01, .high = 100};

Pattern scale(const Pattern& pattern, double coefficient) {
  return {pattern.even * coefficient, pattern.odd * coefficient};
}

dvec3 read_absorption(const JsonValue& value) {
  if (value.json().is_array()) return value.vec3(at_least_0);
  if (!value.json().is_object())
    value.wanted("absorption per unit of length [r, g, b] or {\"color\": what is left, \"distance\": after}");
  return value.object("absorption", [](JsonObject& object) {
    const dvec3 left =
        object.at("color", "a colour [r, g, b]").color({.low = 0, .high = 1, .low_open = true});
    // + 0.0: a colour of 1 gives 0, not -0
    return -glm::log(left) / object.at("distance", "a length").number(above_0) + 0.0;
  });
}

/// One term of the shading: a coefficient on the material's colour, or {"color", "coefficient"} (and for
/// specular "exponent"). `written` is the coefficient of an object that gives none.
Pattern read_term(const JsonValue& value, const Pattern& color, double written, const Range& range,
                  double* exponent) {
  if (value.json().is_number()) return scale(color, value.number(range));
  if (!value.json().is_object())
    value.wanted("a coefficient or {\"color\": [r, g, b], \"coefficient\": number}");
  return value.object(exponent          ? "specular_term"
                      : range.high <= 1 ? "ray_term"
                                        : "term",
                      [&](JsonObject& object) {
                        Pattern result = color;
                        if (const auto own = object.find("color"))
                          result.even = result.odd = own->color(range);
                        if (exponent)
                          *exponent = object.number("exponent", *exponent, {.low = 0, .high = 1e6});
                        return scale(result, object.number("coefficient", written, range));
                      });
}

Pattern read_color(JsonObject& object, MaterialDescription& material) {
  Pattern pattern;
  const auto color = object.find("color");
  if (!color) return pattern;
  if (color->json().is_array()) {
    pattern.even = pattern.odd = color->color();
    return pattern;
  }
  if (!color->json().is_object())
    color->wanted("a colour [r, g, b] or {\"checker\": [colour, colour], \"size\": number}");
  color->object("checker", [&](JsonObject& checker) {
    const JsonValue pair = checker.at("checker", "two colours");
    const auto colors = pair.items("2 colours");
    if (colors.size() != 2) pair.wanted("an array of 2 colours");
    pattern = {colors[0].color(), colors[1].color()};
    material.checker = true;
    material.checker_size = checker.number("size", 1, above_0);
  });
  return pattern;
}

void read_local_terms(JsonObject& object, MaterialDescription& material) {
  const bool dielectric = material.type == MaterialType::dielectric;
  const Pattern color = read_color(object, material);
  const auto term = [&](std::string_view key, const Pattern& base, double missing, double written,
                        double* exponent) {
    const auto found = object.find(key);
    return found ? read_term(*found, base, written, color_range, exponent)
                 : scale(base, dielectric ? 0 : missing);
  };
  const Pattern ambient = term("ambient", color, 0.1, 0.1, nullptr);
  const Pattern diffuse = term("diffuse", color, 0.8, 0.8, nullptr);
  material.ambient = ambient.even, material.checker_ambient = ambient.odd;
  material.diffuse = diffuse.even, material.checker_diffuse = diffuse.odd;
  material.specular = term("specular", {}, 0, 1, &material.exponent).even;
  if (dielectric && object.has("color") && !object.has("ambient") && !object.has("diffuse"))
    object.find("color")->fail(
        "a dielectric has no \"color\" unless it has \"ambient\" or \"diffuse\": tint it by \"transmission\" "
        "or by its "
        "medium's \"absorption\"");
}

void read_interior(JsonObject& object, MaterialDescription& material, const NameTable& names,
                   std::vector<MediumDescription>& media) {
  object.not_both("medium", "ior");
  if (const auto medium = object.find("medium")) {
    material.medium = find_name(*medium, names, "medium");
  } else if (const auto ior = object.find("ior")) {
    material.medium = static_cast<int>(media.size());
    media.push_back({.name = material.name, .ior = ior->number(ior_range)});
  } else if (material.type == MaterialType::dielectric) {
    object.at("ior", "a dielectric's index of refraction, or \"medium\" and a medium's name");
  }
}

}  // namespace

int find_name(const JsonValue& name, const NameTable& table, std::string_view what) {
  const std::string text = name.text();
  if (const auto found = table.find(text); found != table.end()) return found->second;
  std::vector<std::string> known;
  for (const auto& [key, index] : table) known.push_back(key);
  const std::string mend =
      did_you_mean(text, known,
                   known.empty() ? fmt::format("the scene names no {}", what)
                                 : fmt::format("the scene has \"{}\"", fmt::join(known, "\", \"")));
  name.wanted(fmt::format("the name of a {} of this scene ({})", what, mend));
}

MediumDescription read_medium(const JsonValue& value, std::string name) {
  return value.object("medium", [&](JsonObject& object) {
    MediumDescription medium{.name = std::move(name)};
    medium.ior = object.number("ior", medium.ior, ior_range);
    if (const auto absorption = object.find("absorption")) medium.absorption = read_absorption(*absorption);
    medium.priority = object.integer("priority", medium.priority, -1000, 1000);
    return medium;
  });
}

MaterialDescription read_material(const JsonValue& value, std::string name, const NameTable& medium_names,
                                  std::vector<MediumDescription>& media) {
  static constexpr std::string_view types[] = {"phong", "dielectric"}, shadings[] = {"phong", "blinn"},
                                    shadows[] = {"filter", "opaque"};
  return value.object("material", [&](JsonObject& object) {
    MaterialDescription material;
    material.name = std::move(name);
    const bool dielectric = object.choice("type", "phong", types) == "dielectric";
    material.type = dielectric ? MaterialType::dielectric : MaterialType::phong;
    read_local_terms(object, material);
    material.blinn = object.choice("shading", "phong", shadings) == "blinn";
    const auto ray_term = [&](std::string_view key) {
      const auto found = object.find(key);
      return found ? read_term(*found, {}, 1, zero_to_one, nullptr).even : dvec3(dielectric ? 1 : 0);
    };
    material.reflection = ray_term("reflection");
    material.transmission = ray_term("transmission");
    material.roughness = object.number("roughness", material.roughness, zero_to_one);
    read_interior(object, material, medium_names, media);
    material.shadow_opaque = object.choice("shadow", "filter", shadows) == "opaque";
    material.vertex_color = object.boolean("vertex_color", false);
    return material;
  });
}

}  // namespace sundog
