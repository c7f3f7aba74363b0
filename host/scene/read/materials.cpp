// Reads media and materials.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

#include "base/names.h"
#include "scene/materials/presets.h"
#include "scene/read/surface_terms.h"
#include "scene/read/textures.h"

namespace sundog {

namespace {

Pattern scale(const Pattern& pattern, double coefficient) {
  return {pattern.even * coefficient, pattern.odd * coefficient, pattern.texture};
}

dvec3 read_absorption(const JsonValue& value) {
  if (value.json().is_array()) return value.vec3(at_least_0);
  if (!value.json().is_object())
    value.wanted(
        "absorption per unit of length [r, g, b] or {\"color\": transmittance, \"distance\": its length}");
  return value.object("absorption", [](JsonObject& object) {
    const dvec3 left =
        object.at("color", "a colour [r, g, b]").color({.low = 0, .high = 1, .low_open = true});
    // + 0.0 turns the -0 of a colour of 1 into 0
    return -glm::log(left) / object.at("distance", "a length").number(above_0) + 0.0;
  });
}

/// Checks that a dispersion formula gives a valid index at every visible wavelength.
void check_indices(const JsonValue& value, MediumDescription& medium) {
  for (double wavelength = 380; wavelength <= 780; wavelength += 5) {
    const double index = index_at(medium.dispersion, medium.ior, wavelength);
    if (!(index >= ior_range.low && index <= ior_range.high))
      value.fail(fmt::format("the index of refraction at {} nm is {:.4g}, and should be from {} to {}",
                             wavelength, index, ior_range.low, ior_range.high));
  }
  medium.ior = index_at(medium.dispersion, medium.ior, line_d);
}

Dispersion read_substance(const JsonValue& value) {
  const std::string name = value.text();
  if (const auto found = find_substance(name)) return *found;
  std::vector<std::string> known;
  for (const Substance& substance : substances()) known.emplace_back(substance.name);
  value.wanted(fmt::format("an index of refraction or one of \"{}\"", fmt::join(known, "\", \"")));
}

/// Two or three Cauchy coefficients, or pairs for Sellmeier.
Dispersion read_formula(const JsonValue& value, DispersionKind kind) {
  const bool cauchy = kind == DispersionKind::cauchy;
  const auto items = value.items(cauchy ? "2 or 3 numbers" : "2, 4, 6 or 8 numbers");
  const bool good = cauchy ? items.size() == 2 || items.size() == 3
                           : items.size() >= 2 && items.size() <= 8 && items.size() % 2 == 0;
  if (!good) value.wanted(cauchy ? "an array of 2 or 3 numbers" : "an array of 2, 4, 6 or 8 numbers");
  Dispersion dispersion{kind, {}};
  for (std::size_t i = 0; i < items.size(); ++i)
    dispersion.coefficients[i] = items[i].number({.low = -1e3, .high = 1e3});
  return dispersion;
}

/// "ior", a number or a substance; a number may have "abbe" beside it.
void read_ior(JsonObject& object, MediumDescription& medium) {
  const auto ior = object.find("ior"), abbe = object.find("abbe");
  if (abbe && !ior) abbe->fail("wanted an \"ior\" beside it: the index of refraction at 587.6 nm");
  if (!ior) return;
  if (ior->json().is_string()) {
    if (abbe) abbe->fail("the \"ior\" is a substance's, which has its own dispersion");
    medium.dispersion = read_substance(*ior);
    check_indices(*ior, medium);
    return;
  }
  medium.ior = ior->number(ior_range);
  if (!abbe) return;
  medium.dispersion = cauchy_of_abbe(medium.ior, abbe->number({.low = 1, .high = 1e4}));
  check_indices(*abbe, medium);
}

/// "ior" as above, "cauchy", or "sellmeier".
void read_index(JsonObject& object, MediumDescription& medium) {
  object.not_both("ior", "cauchy");
  object.not_both("ior", "sellmeier");
  object.not_both("cauchy", "sellmeier");
  read_ior(object, medium);
  static constexpr std::pair<std::string_view, DispersionKind> formulas[] = {
      {"cauchy", DispersionKind::cauchy}, {"sellmeier", DispersionKind::sellmeier}};
  for (const auto& [key, kind] : formulas)
    if (const auto formula = object.find(key)) {
      medium.dispersion = read_formula(*formula, kind);
      check_indices(*formula, medium);
    }
}

/// Other programs write {"texture": NAME} instead of the name.
void refuse_texture_object(const JsonValue& value) {
  if (value.json().is_object() && value.json().contains("texture"))
    value.fail("a texture is taken by its name alone: wanted the name of one of /textures as a string");
}

}  // namespace

Pattern read_plain_color(const JsonValue& value, TextureLibrary& textures, const Range& range) {
  refuse_texture_object(value);
  if (value.json().is_string()) return {dvec3(1), dvec3(1), textures.use(value, TextureUse::color)};
  const dvec3 color = value.color(range);
  return {color, color, -1};
}

double read_number(const JsonValue& value, TextureLibrary& textures, const Range& range, int* texture) {
  refuse_texture_object(value);
  if (!value.json().is_string()) return value.number(range);
  *texture = textures.use(value, TextureUse::number);
  return 1;
}

namespace {

/// Defaults of a shading term, and where to store an exponent.
struct TermRules {
  Pattern color;
  double coefficient = 1;  // for an object or a texture without one
  Range range = color_range;
  double* exponent = nullptr;
  int* exponent_texture = nullptr;
};

/// A shading term: a coefficient on the material's colour, a texture's name, or {"color", "coefficient"}
/// (specular: also "exponent").
Pattern read_term(const JsonValue& value, TextureLibrary& textures, const TermRules& rules) {
  refuse_texture_object(value);
  if (value.json().is_number()) return scale(rules.color, value.number(rules.range));
  if (value.json().is_string()) return scale(read_plain_color(value, textures), rules.coefficient);
  if (!value.json().is_object())
    value.wanted("a coefficient, a texture's name or {\"color\": [r, g, b], \"coefficient\": number}");
  return value.object(rules.exponent          ? "specular_term"
                      : rules.range.high <= 1 ? "ray_term"
                                              : "term",
                      [&](JsonObject& object) {
                        Pattern result = rules.color;
                        if (const auto own = object.find("color"))
                          result = read_plain_color(*own, textures, rules.range);
                        if (rules.exponent)
                          if (const auto exponent = object.find("exponent"))
                            *rules.exponent = read_number(*exponent, textures, {.low = 0, .high = 1e6},
                                                          rules.exponent_texture);
                        return scale(result, object.number("coefficient", rules.coefficient, rules.range));
                      });
}

Pattern read_color(JsonObject& object, MaterialDescription& material, TextureLibrary& textures) {
  Pattern pattern;
  const auto color = object.find("color");
  if (!color) return pattern;
  if (color->json().is_array() || color->json().is_string()) return read_plain_color(*color, textures);
  if (!color->json().is_object())
    color->wanted(
        "a colour [r, g, b], a texture's name or {\"checker\": [colour, colour], \"size\": number}");
  refuse_texture_object(*color);
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

void read_local_terms(JsonObject& object, MaterialDescription& material, TextureLibrary& textures) {
  const bool dielectric = material.type == MaterialType::dielectric;
  const Pattern color = read_color(object, material, textures);
  MaterialTextures& maps = material.textures;
  const auto term = [&](std::string_view key, double missing, const TermRules& rules) {
    const auto found = object.find(key);
    return found ? read_term(*found, textures, rules) : scale(rules.color, dielectric ? 0 : missing);
  };
  const Pattern ambient = term("ambient", 0.1, {.color = color, .coefficient = 0.1});
  const Pattern diffuse = term("diffuse", 0.8, {.color = color, .coefficient = 0.8});
  const Pattern specular =
      term("specular", 0, {.color = {}, .exponent = &material.exponent, .exponent_texture = &maps.exponent});
  material.ambient = ambient.even, material.checker_ambient = ambient.odd, maps.ambient = ambient.texture;
  material.diffuse = diffuse.even, material.checker_diffuse = diffuse.odd, maps.diffuse = diffuse.texture;
  material.specular = specular.even, maps.specular = specular.texture;
  if (const auto emission = object.find("emission")) {
    const Pattern light = emission->json().is_array() ? read_plain_color(*emission, textures)
                                                      : read_term(*emission, textures, {.color = {}});
    material.emission = light.even, maps.emission = light.texture;
  }
  if (dielectric && object.has("color") && !object.has("ambient") && !object.has("diffuse"))
    object.find("color")->fail(
        "a dielectric has no \"color\" unless it has \"ambient\" or \"diffuse\": tint it by \"transmission\" "
        "or by its "
        "medium's \"absorption\"");
}

/// A thin wall has an index and no inside.
void read_wall(JsonObject& object, const JsonValue& thin, MaterialDescription& material) {
  if (material.type != MaterialType::dielectric || object.has("medium"))
    thin.fail("a thin wall is a dielectric with an \"ior\" and no \"medium\"");
  object.at("ior", "the index of refraction of a thin wall");
  MediumDescription wall;
  read_ior(object, wall);
  material.wall_ior = wall.ior;
}

void read_interior(JsonObject& object, MaterialDescription& material, const NameTable& names,
                   std::vector<MediumDescription>& media) {
  object.not_both("medium", "ior");
  object.not_both("medium", "abbe");
  if (const auto thin = object.find("thin_walled"); thin && thin->boolean()) {
    read_wall(object, *thin, material);
    return;
  }
  if (const auto medium = object.find("medium")) {
    material.medium = find_name(*medium, names, "medium");
  } else if (object.has("ior") || object.has("abbe")) {
    material.medium = static_cast<int>(media.size());
    MediumDescription inside{.name = material.name};
    read_ior(object, inside);
    media.push_back(inside);
  } else if (material.type == MaterialType::dielectric) {
    object.at("ior", "a dielectric's index of refraction, or \"medium\" and a medium's name");
  }
}

/// {"texture": name, KEY: number}, or the name only.
int read_relief(const JsonValue& value, TextureLibrary& textures, TextureUse use, const char* kind,
                const char* key, double* number, const Range& range = {.low = -1e6, .high = 1e6}) {
  if (value.json().is_string()) return textures.use(value, use);
  if (!value.json().is_object()) value.wanted("the name of a texture, or an object");
  return value.object(kind, [&](JsonObject& object) {
    *number = object.number(key, *number, range);
    return textures.use(object.at("texture", "the name of a texture"), use);
  });
}

int read_displacement(const JsonValue& value, TextureLibrary& textures, MaterialDescription& material) {
  if (value.json().is_string()) return textures.use(value, TextureUse::number);
  if (!value.json().is_object()) value.wanted("the name of a texture, or an object");
  return value.object("displacement_map", [&](JsonObject& object) {
    material.displacement = object.number("height", material.displacement, {.low = -1e6, .high = 1e6});
    material.displacement_middle = object.number("middle", 0, zero_to_one);
    material.displacement_edge = object.number("edge", 0, {.low = 0, .high = 1e6});
    return textures.use(object.at("texture", "the name of a texture"), TextureUse::number);
  });
}

}  // namespace

void read_surface(JsonObject& object, MaterialDescription& material, TextureLibrary& textures) {
  static constexpr std::string_view sides[] = {"both", "front"}, shadows[] = {"filter", "opaque"};
  if (const auto map = object.find("normal_map"))
    material.textures.normal =
        read_relief(*map, textures, TextureUse::data, "normal_map", "scale", &material.normal_scale);
  if (const auto bump = object.find("bump"))
    material.textures.height =
        read_relief(*bump, textures, TextureUse::number, "bump_map", "height", &material.bump);
  if (const auto parallax = object.find("parallax")) {
    object.not_both("bump", "parallax");
    material.parallax = 1;
    material.textures.height = read_relief(*parallax, textures, TextureUse::number, "parallax_map", "depth",
                                           &material.parallax, {.low = 0, .high = 1e6});
    material.bump = material.textures.normal < 0 ? material.parallax : 0;
  }
  if (const auto displacement = object.find("displacement"))
    material.displaced_by = read_displacement(*displacement, textures, material);
  if (const auto occlusion = object.find("occlusion"))
    material.textures.occlusion = textures.use(*occlusion, TextureUse::number);
  material.one_sided = object.choice("sides", "both", sides) == "front";
  if (material.one_sided && (material.medium >= 0 || material.wall_ior > 0))
    object.find("sides")->fail("a material with a \"medium\" or an \"ior\" has both sides");
  material.shadow_opaque = object.choice("shadow", "filter", shadows) == "opaque";
  material.shadow_filter = object.has("shadow") && !material.shadow_opaque;
  material.vertex_color = object.boolean("vertex_color", false);
}

namespace {

void read_opacity(JsonObject& object, MaterialDescription& material, TextureLibrary& textures) {
  const auto opacity = object.find("opacity");
  material.cutoff = object.number("cutoff", 0, zero_to_one);
  if (!opacity) return;
  material.opacity = read_number(*opacity, textures, zero_to_one, &material.textures.opacity);
  if ((material.medium >= 0 || material.wall_ior > 0) &&
      (material.opacity < 1 || material.textures.opacity >= 0))
    opacity->fail(
        "a material with a \"medium\" or an \"ior\" is not partly there: give it a \"transmission\" "
        "instead");
}

}  // namespace

int find_name(const JsonValue& name, const NameTable& table, std::string_view what) {
  const std::string text = name.text();
  if (const auto found = table.find(text); found != table.end()) return found->second;
  std::vector<std::string> known;
  for (const auto& [key, index] : table) known.push_back(key);
  const std::string own = known.empty() ? fmt::format("the scene names no {}", what)
                                        : fmt::format("the scene has \"{}\"", fmt::join(known, "\", \""));
  const bool presets = what == "material";
  if (presets) std::ranges::copy(preset_names(), std::back_inserter(known));
  const std::string mend = did_you_mean(
      text, known, presets ? own + ", and docs/materials.md lists presets such as \"ice\"" : own);
  name.wanted(fmt::format("the name of a {} of this scene ({})", what, mend));
}

MediumDescription read_medium(const JsonValue& value, std::string name) {
  return value.object("medium", [&](JsonObject& object) {
    MediumDescription medium{.name = std::move(name)};
    read_index(object, medium);
    if (const auto absorption = object.find("absorption")) medium.absorption = read_absorption(*absorption);
    if (const auto scattering = object.find("scattering")) medium.scattering = scattering->vec3(at_least_0);
    medium.anisotropy = object.number("anisotropy", medium.anisotropy, mean_cosines);
    medium.priority = object.integer("priority", medium.priority, -1000, 1000);
    return medium;
  });
}

MaterialDescription read_material(const JsonValue& value, std::string name, const NameTable& medium_names,
                                  std::vector<MediumDescription>& media, TextureLibrary& textures) {
  static constexpr std::string_view types[] = {"phong", "dielectric", "openpbr"},
                                    shadings[] = {"phong", "blinn"};
  if (value.json().is_object() && value.json().contains("type") && value.json()["type"] == "openpbr")
    return read_openpbr(value, std::move(name), media, textures);
  return value.object("material", [&](JsonObject& object) {
    MaterialDescription material;
    material.name = std::move(name);
    const bool dielectric = object.choice("type", "phong", types) == "dielectric";
    material.type = dielectric ? MaterialType::dielectric : MaterialType::phong;
    read_local_terms(object, material, textures);
    material.blinn = object.choice("shading", "phong", shadings) == "blinn";
    const auto ray_term = [&](std::string_view key) {
      const auto found = object.find(key);
      if (!found) return Pattern{dvec3(dielectric ? 1 : 0), dvec3(1), -1};
      return read_term(*found, textures, {.color = {}, .range = zero_to_one});
    };
    const Pattern reflection = ray_term("reflection"), transmission = ray_term("transmission");
    material.reflection = reflection.even, material.textures.reflection = reflection.texture;
    material.transmission = transmission.even, material.textures.transmission = transmission.texture;
    material.roughness = object.number("roughness", material.roughness, zero_to_one);
    material.multiple_scattering = object.boolean("multiple_scattering", material.multiple_scattering);
    read_interior(object, material, medium_names, media);
    read_opacity(object, material, textures);
    read_surface(object, material, textures);
    return material;
  });
}

}  // namespace sundog
