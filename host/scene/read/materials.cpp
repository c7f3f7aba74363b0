// Reads media and materials of a scene file: indices of refraction, shading terms, interiors, reliefs.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>

#include "base/names.h"
#include "scene/json/members.h"
#include "scene/materials/presets.h"
#include "scene/read/surface_terms.h"
#include "scene/read/textures.h"

namespace sundog {

namespace {

Pattern scale(const Pattern& pattern, double coefficient) {
  return {pattern.even * coefficient, pattern.odd * coefficient, pattern.texture};
}

dvec3 read_absorption(const JsonValue& value) {
  if (value.json().is_array()) return value.vec3();
  return value.object("absorption", [](JsonObject& object) {
    // + 0.0 turns the -0 of a colour of 1 into 0.
    return -glm::log(object.at("color").vec3()) / object.at("distance").number() + 0.0;
  });
}

/// Checks that a dispersion formula gives a valid index at every visible wavelength.
void check_indices(const JsonValue& value, MediumDescription& medium) {
  const Range range = schema_rule("ior")->as(SchemaRule::Type::number)->range;
  for (double wavelength = 380; wavelength <= 780; wavelength += 5) {
    const double index = index_at(medium.dispersion, medium.ior, wavelength);
    if (!(index >= range.low && index <= range.high))
      value.fail(fmt::format("the index of refraction at {} nm is {:.4g}, and should be from {} to {}",
                             wavelength, index, range.low, range.high));
  }
  medium.ior = index_at(medium.dispersion, medium.ior, line_d);
}

/// Reads two or three Cauchy coefficients, or pairs of coefficients for Sellmeier.
Dispersion read_formula(const JsonValue& value, DispersionKind kind) {
  const bool cauchy = kind == DispersionKind::cauchy;
  const auto items = value.items("numbers");
  if (!cauchy && items.size() % 2 != 0) value.wanted("an array of 2, 4, 6 or 8 numbers");
  Dispersion dispersion{kind, {}};
  for (std::size_t i = 0; i < items.size(); ++i) dispersion.coefficients[i] = items[i].number();
  return dispersion;
}

/// Reads "ior", a number or a substance; a number may have "abbe" beside it.
void read_ior(JsonObject& object, MediumDescription& medium) {
  const auto ior = object.find("ior"), abbe = object.find("abbe");
  if (!ior) return;
  if (ior->json().is_string()) {
    if (abbe) abbe->fail("the \"ior\" is a substance's, which has its own dispersion");
    medium.dispersion = *find_substance(ior->choice());
    check_indices(*ior, medium);
    return;
  }
  medium.ior = ior->number();
  if (!abbe) return;
  medium.dispersion = cauchy_of_abbe(medium.ior, abbe->number());
  check_indices(*abbe, medium);
}

/// Reads "ior" as above, "cauchy" or "sellmeier".
void read_index(JsonObject& object, MediumDescription& medium) {
  read_ior(object, medium);
  static constexpr std::pair<std::string_view, DispersionKind> formulas[] = {
      {"cauchy", DispersionKind::cauchy}, {"sellmeier", DispersionKind::sellmeier}};
  for (const auto& [key, kind] : formulas)
    if (const auto formula = object.find(key)) {
      medium.dispersion = read_formula(*formula, kind);
      check_indices(*formula, medium);
    }
}

/// Refuses {"texture": NAME}, which other programs write instead of the name.
void refuse_texture_object(const JsonValue& value) {
  if (value.json().is_object() && value.json().contains("texture"))
    value.fail("a texture is taken by its name alone: wanted the name of one of /textures as a string");
}

/// Defaults of a shading term, and where its exponent is stored.
struct TermRules {
  Pattern color;
  double coefficient = 1;  // for an object or a texture without its own
  const char* kind = "term";
  double* exponent = nullptr;
  int* exponent_texture = nullptr;
};

/// Reads a shading term: a coefficient of the material's colour, a texture's name, or {"color",
/// "coefficient"} (specular: also "exponent").
Pattern read_term(const JsonValue& value, TextureLibrary& textures, const TermRules& rules) {
  refuse_texture_object(value);
  if (value.json().is_number()) return scale(rules.color, value.number());
  if (value.json().is_string()) return scale(read_plain_color(value, textures), rules.coefficient);
  return value.object(rules.kind, [&](JsonObject& object) {
    Pattern result = rules.color;
    if (const auto own = object.find("color")) result = read_plain_color(*own, textures);
    if (rules.exponent) read_number(object, "exponent", *rules.exponent, *rules.exponent_texture, textures);
    double coefficient = rules.coefficient;
    object.read("coefficient", coefficient);
    return scale(result, coefficient);
  });
}

Pattern read_color(JsonObject& object, MaterialDescription& material, TextureLibrary& textures) {
  Pattern pattern;
  const auto color = object.find("color");
  if (!color) return pattern;
  if (color->json().is_array() || color->json().is_string()) {
    const Pattern plain = read_plain_color(*color, textures);
    if (std::max({plain.even.x, plain.even.y, plain.even.z}) > 10)
      color->warn(
          "makes a surface that returns many times the light it gets: colours are linear, from 0 to 1");
    return plain;
  }
  refuse_texture_object(*color);
  color->object("checker", [&](JsonObject& checker) {
    const auto colors = checker.at("checker").items("colours");
    pattern = {colors[0].vec3(), colors[1].vec3()};
    material.checker = true;
    checker.read("size", material.checker_size);
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
  const Pattern specular = term("specular", 0,
                                {.color = {},
                                 .kind = "specular_term",
                                 .exponent = &material.exponent,
                                 .exponent_texture = &maps.exponent});
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
        "or by its medium's \"absorption\"");
}

/// Reads a thin wall, which has an index but no inside.
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
  if (const auto thin = object.find("thin_walled"); thin && thin->boolean()) {
    read_wall(object, *thin, material);
    return;
  }
  if (const auto medium = object.find("medium")) {
    material.medium = find_name(*medium, names, "medium");
  } else if (object.has("ior")) {
    material.medium = static_cast<int>(media.size());
    MediumDescription inside{.name = material.name};
    read_ior(object, inside);
    media.push_back(inside);
  } else if (material.type == MaterialType::dielectric) {
    object.at("ior", "a dielectric's index of refraction, or \"medium\" and a medium's name");
  }
}

/// Reads {"texture": name, KEY: number}, or only the name.
int read_relief(const JsonValue& value, TextureLibrary& textures, TextureUse use, const char* kind,
                MaterialDescription& material, const char* key, double& number) {
  if (value.json().is_string()) return textures.use(value, use);
  return value.object(kind, [&](JsonObject& object) {
    object.read(key, number);
    if (object.knows("edge"))
      object.read("middle", material.displacement_middle, "edge", material.displacement_edge);
    return textures.use(object.at("texture"), use);
  });
}

void read_opacity(JsonObject& object, MaterialDescription& material, TextureLibrary& textures) {
  object.read("cutoff", material.cutoff);
  read_number(object, "opacity", material.opacity, material.textures.opacity, textures);
  if ((material.medium >= 0 || material.wall_ior > 0) &&
      (material.opacity < 1 || material.textures.opacity >= 0))
    object.at("opacity").fail(
        "a material with a \"medium\" or an \"ior\" is not partly there: give it a \"transmission\" instead");
}

}  // namespace

Pattern read_plain_color(const JsonValue& value, TextureLibrary& textures) {
  refuse_texture_object(value);
  if (value.json().is_string()) return {dvec3(1), dvec3(1), textures.use(value, TextureUse::color)};
  const dvec3 color = value.vec3();
  return {color, color, -1};
}

void read_number(JsonObject& object, std::string_view key, double& to, int& texture,
                 TextureLibrary& textures) {
  const auto value = object.find(key);
  if (!value) return object.read(key, to);
  refuse_texture_object(*value);
  if (!value->json().is_string()) return value->get(to);
  texture = textures.use(*value, TextureUse::number);
  to = 1;
}

void read_surface(JsonObject& object, MaterialDescription& material, TextureLibrary& textures) {
  if (const auto map = object.find("normal_map"))
    material.textures.normal =
        read_relief(*map, textures, TextureUse::data, "normal_map", material, "scale", material.normal_scale);
  if (const auto bump = object.find("bump"))
    material.textures.height =
        read_relief(*bump, textures, TextureUse::number, "bump_map", material, "height", material.bump);
  if (const auto parallax = object.find("parallax")) {
    material.parallax = 1;
    material.textures.height = read_relief(*parallax, textures, TextureUse::number, "parallax_map", material,
                                           "depth", material.parallax);
    material.bump = material.textures.normal < 0 ? material.parallax : 0;
  }
  if (const auto displacement = object.find("displacement"))
    material.displaced_by = read_relief(*displacement, textures, TextureUse::number, "displacement_map",
                                        material, "height", material.displacement);
  if (const auto occlusion = object.find("occlusion"))
    material.textures.occlusion = textures.use(*occlusion, TextureUse::number);
  std::string sides, shadow;
  object.read("sides", sides, "shadow", shadow, "vertex_color", material.vertex_color);
  object.read("shadow_catcher", material.shadow_catcher, "group", material.group);
  if (material.shadow_catcher && (material.medium >= 0 || material.wall_ior > 0))
    object.at("shadow_catcher").fail("a material with a \"medium\" or an \"ior\" catches no shadows");
  material.one_sided = sides == "front";
  if (material.one_sided && (material.medium >= 0 || material.wall_ior > 0))
    object.find("sides")->fail("a material with a \"medium\" or an \"ior\" has both sides");
  material.shadow_opaque = shadow == "opaque";
  material.shadow_filter = object.has("shadow") && !material.shadow_opaque;
}

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
      text, known, presets ? own + ", and docs/guide/materials.md lists presets such as \"ice\"" : own);
  const char* plain = what == "texture" ? "; a colour is written [r, g, b], a number without quotes" : "";
  name.wanted(fmt::format("the name of a {} of this scene ({}{})", what, mend, plain));
}

MediumDescription read_medium(const JsonValue& value, std::string name) {
  return value.object("medium", [&](JsonObject& object) {
    MediumDescription medium{.name = std::move(name)};
    read_index(object, medium);
    if (const auto absorption = object.find("absorption")) medium.absorption = read_absorption(*absorption);
    read_members(object, medium, {"ior", "absorption"});
    return medium;
  });
}

MaterialDescription read_material(const JsonValue& value, std::string name, const NameTable& medium_names,
                                  std::vector<MediumDescription>& media, TextureLibrary& textures) {
  if (value.json().is_object() && value.json().contains("type") && value.type() == "openpbr")
    return read_openpbr(value, std::move(name), media, textures);
  return value.object("material", [&](JsonObject& object) {
    MaterialDescription material;
    material.name = std::move(name);
    std::string shading;
    object.read("type", material.type, "shading", shading);
    object.read("roughness", material.roughness, "multiple_scattering", material.multiple_scattering);
    const bool dielectric = material.type == MaterialType::dielectric;
    read_local_terms(object, material, textures);
    material.blinn = shading == "blinn";
    const auto ray_term = [&](std::string_view key) {
      const auto found = object.find(key);
      if (!found) return Pattern{dvec3(dielectric ? 1 : 0), dvec3(1), -1};
      return read_term(*found, textures, {.color = {}, .kind = "ray_term"});
    };
    const Pattern reflection = ray_term("reflection"), transmission = ray_term("transmission");
    material.reflection = reflection.even, material.textures.reflection = reflection.texture;
    material.transmission = transmission.even, material.textures.transmission = transmission.texture;
    read_interior(object, material, medium_names, media);
    read_opacity(object, material, textures);
    read_surface(object, material, textures);
    return material;
  });
}

}  // namespace sundog
