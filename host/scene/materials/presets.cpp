// Holds the table of presets as JSON, with its sources; adds presets that a scene names to its sections.
#include "scene/materials/presets.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>
#include <set>

#include "base/names.h"

namespace sundog {
using nlohmann::json;

namespace {

// One material per entry; "inside" is its medium, with lengths in metres. Sources: indices of glasses, water,
// ice and diamond: spectra/refraction.cpp; plastics: Sultanova et al. 2009; drinks: from their sugar (ICUMSA)
// and alcohol (CRC Handbook). Absorption of water: Pope and Fry 1997; ice: Warren and Brandt 2008; beer,
// wine, juice, cola: Narasimhan et al. 2006; whisky: by eye. The rest, and the colours of metals (indices by
// Palik et al.) and matte surfaces: physicallybased.info (CC0). Wax, jade, wood and the textures: by eye. The
// index of jade (jadeite): CRC Handbook.
constexpr const char* table = R"({
"glass": {"type": "dielectric", "ior": 1.5},
"window_glass": {"type": "dielectric", "inside": {"ior": 1.52, "absorption": [1.6, 0.5, 0.5]}},
"crown_glass": {"type": "dielectric", "ior": "BK7"},
"flint_glass": {"type": "dielectric", "ior": "F2"},
"heavy_flint_glass": {"type": "dielectric", "ior": "SF10"},
"fused_silica": {"type": "dielectric", "ior": "fused_silica"},
"frosted_glass": {"type": "dielectric", "ior": 1.5, "roughness": 0.3},
"acrylic": {"type": "dielectric", "ior": 1.4905, "abbe": 57.4},
"polycarbonate": {"type": "dielectric", "ior": 1.5848, "abbe": 29.9},
"diamond": {"type": "dielectric", "ior": "diamond"},
"sapphire": {"type": "dielectric", "inside": {"ior": 1.768, "abbe": 72.2, "absorption": [40, 26.9, 15.7]}},
"amber": {"type": "dielectric", "inside": {"ior": 1.54, "absorption": [18.6, 124, 332]}},
"ice": {"type": "dielectric", "inside": {"ior": "ice", "absorption": [0.12, 0.05, 0.003], "priority": 2}},
"water": {"type": "dielectric", "inside": {"ior": "water", "absorption": [0.28, 0.055, 0.0098], "priority": 1}},
"beer": {"type": "dielectric", "inside": {"ior": 1.34, "absorption": [11.5, 24.9, 57.8], "priority": 1}},
"white_wine": {"type": "dielectric", "inside": {"ior": 1.343, "absorption": [10.8, 11.9, 24], "priority": 1}},
"red_wine": {"type": "dielectric", "inside": {"ior": 1.345, "absorption": [116, 252, 294], "priority": 1}},
"whisky": {"type": "dielectric", "inside": {"ior": 1.356, "absorption": [6, 22, 75], "priority": 1}},
"honey": {"type": "dielectric", "inside": {"ior": 1.4915, "absorption": [18.5, 56, 330], "priority": 1}},
"olive_oil": {"type": "dielectric", "inside": {"ior": 1.467, "absorption": [30.4, 37.5, 240], "priority": 1}},
"apple_juice": {"type": "dielectric", "inside": {"ior": 1.349, "absorption": [13, 23.7, 52.2], "priority": 1}},
"cranberry_juice": {"type": "dielectric", "inside": {"ior": 1.351, "absorption": [39.4, 94.2, 124], "priority": 1}},
"grape_juice": {"type": "dielectric", "inside": {"ior": 1.356, "absorption": [104, 240, 293], "priority": 1}},
"cola": {"type": "dielectric", "inside": {"ior": 1.349, "absorption": [100, 165, 247], "priority": 1}},
"coffee": {"type": "dielectric", "inside": {"ior": 1.34, "absorption": [80.5, 202, 338], "priority": 1}},
"aluminium": {"type": "openpbr", "base_metalness": 1, "base_color": [0.916, 0.923, 0.924], "specular_roughness": 0.1},
"brushed_aluminium": {"type": "openpbr", "base_metalness": 1, "base_color": [0.916, 0.923, 0.924], "specular_roughness": 0.35,
  "specular_roughness_anisotropy": 0.8},
"brass": {"type": "openpbr", "base_metalness": 1, "base_color": [0.91, 0.778, 0.423], "specular_roughness": 0.1},
"chromium": {"type": "openpbr", "base_metalness": 1, "base_color": [0.654, 0.685, 0.701], "specular_roughness": 0.02},
"copper": {"type": "openpbr", "base_metalness": 1, "base_color": [0.932, 0.623, 0.522], "specular_roughness": 0.1},
"gold": {"type": "openpbr", "base_metalness": 1, "base_color": [1, 0.773, 0.307], "specular_roughness": 0.1},
"iron": {"type": "openpbr", "base_metalness": 1, "base_color": [0.53, 0.513, 0.494], "specular_roughness": 0.4},
"mercury": {"type": "openpbr", "base_metalness": 1, "base_color": [0.781, 0.78, 0.778], "specular_roughness": 0},
"mirror": {"type": "openpbr", "base_metalness": 1, "base_color": [0.916, 0.923, 0.924], "specular_roughness": 0},
"nickel": {"type": "openpbr", "base_metalness": 1, "base_color": [0.697, 0.641, 0.563], "specular_roughness": 0.1},
"platinum": {"type": "openpbr", "base_metalness": 1, "base_color": [0.765, 0.73, 0.676], "specular_roughness": 0.1},
"silver": {"type": "openpbr", "base_metalness": 1, "base_color": [0.991, 0.985, 0.974], "specular_roughness": 0.1},
"stainless_steel": {"type": "openpbr", "base_metalness": 1, "base_color": [0.669, 0.639, 0.598], "specular_roughness": 0.2},
"titanium": {"type": "openpbr", "base_metalness": 1, "base_color": [0.441, 0.4, 0.361], "specular_roughness": 0.2},
"zinc": {"type": "openpbr", "base_metalness": 1, "base_color": [0.808, 0.844, 0.865], "specular_roughness": 0.3},
"asphalt": {"type": "openpbr", "base_color": [0.043, 0.041, 0.04], "specular_roughness": 0.7},
"brick": {"type": "openpbr", "base_color": [0.262, 0.095, 0.061], "base_diffuse_roughness": 0.5, "specular_roughness": 0.9},
"car_paint": {"type": "openpbr", "base_color": [0.5, 0.02, 0.02], "base_metalness": 0.5, "coat_weight": 1},
"cardboard": {"type": "openpbr", "base_color": [0.351, 0.208, 0.11], "specular_roughness": 0.8},
"charcoal": {"type": "openpbr", "base_color": [0.02, 0.02, 0.02], "specular_roughness": 0.9},
"chocolate": {"type": "openpbr", "base_color": [0.162, 0.091, 0.06], "specular_roughness": 0.4},
"concrete": {"type": "openpbr", "base_color": [0.51, 0.51, 0.51], "base_diffuse_roughness": 0.5, "specular_roughness": 0.8},
"jade": {"type": "openpbr", "base_color": "jade_veins", "specular_ior": 1.66, "specular_roughness": 0.15},
"oak": {"type": "openpbr", "base_color": "oak_rings", "specular_roughness": 0.45, "bump": {"texture": "oak_pores", "height": 0.0003}},
"oak_floor": {"type": "openpbr", "base_color": "oak_planks", "specular_roughness": 0.4, "bump": {"texture": "oak_pores", "height": 0.0003}},
"open_water": {"type": "openpbr", "base_color": [0.004, 0.02, 0.026], "specular_ior": 1.333, "specular_roughness": 0.015,
  "bump": {"texture": "ripples", "height": 0.004}},
"stone_floor": {"type": "openpbr", "base_color": "slabs", "base_diffuse_roughness": 0.5, "specular_roughness": 0.6,
  "bump": {"texture": "slabs", "height": 0.004}},
"wax": {"type": "openpbr", "base_color": [0.82, 0.72, 0.5], "specular_ior": 1.44, "specular_roughness": 0.35},
"snow_ground": {"type": "openpbr", "base_color": [0.85, 0.85, 0.85], "specular_ior": 1.31, "specular_roughness": 0.5,
  "bump": {"texture": "snow_crust", "height": 0.01}},
"grey_card": {"type": "openpbr", "base_color": [0.18, 0.18, 0.18], "specular_weight": 0},
"marble": {"type": "openpbr", "base_color": [0.83, 0.791, 0.753], "specular_roughness": 0.1},
"milk": {"type": "openpbr", "base_color": [0.815, 0.813, 0.682], "specular_ior": 1.348, "specular_roughness": 0},
"paper": {"type": "openpbr", "base_color": [0.794, 0.834, 0.884], "specular_roughness": 0.8},
"porcelain": {"type": "openpbr", "base_color": [0.745, 0.745, 0.723], "specular_roughness": 0.02},
"rubber": {"type": "openpbr", "base_color": [0.023, 0.023, 0.023], "specular_roughness": 0.7},
"sand": {"type": "openpbr", "base_color": [0.44, 0.386, 0.231], "base_diffuse_roughness": 0.5, "specular_roughness": 0.9},
"snow": {"type": "openpbr", "base_color": [0.85, 0.85, 0.85], "specular_ior": 1.31, "specular_roughness": 0.5},
"terracotta": {"type": "openpbr", "base_color": [0.555, 0.212, 0.11], "specular_roughness": 0.8},
"velvet": {"type": "openpbr", "base_color": [0.12, 0.02, 0.2], "specular_weight": 0, "fuzz_weight": 1, "fuzz_color": [0.6, 0.4, 0.8]}
})";

// Textures, with sizes in metres. Boards, slabs and ripples lie in the xz plane.
constexpr const char* texture_table = R"json({
"drops": {"type": "formula", "size": 0.008, "formula": ["c = floor(p)", "n = c.x * 0.8192 + c.y * 0.6711 + c.z * 0.5497",
  "r = 0.12 + 0.3 * fract(7 * n)", "o = vec3(fract(n), fract(3 * n), fract(5 * n)) * (1 - 2 * r) + r",
  "sqrt(max(1 - pow(distance(p, c + o) / r, 2), 0)) * r"]},
"smudges": {"type": "noise", "size": 0.03, "octaves": 6, "gain": 0.65, "colors": [[0, 0, 0], [0.3, 0.3, 0.3]]},
"jade_veins": {"type": "marble", "size": 0.06, "turbulence": 2, "octaves": 6, "colors": [[0.03, 0.19, 0.07], [0.2, 0.4, 0.2]]},
"oak_rings": {"type": "wood", "size": 0.007, "turbulence": 0.5, "octaves": 6, "colors": [[0.42, 0.27, 0.14], [0.27, 0.15, 0.07]],
  "transform": [{"rotate": {"axis": [0, 0, 1], "degrees": 88}}, {"scale": [9, 1, 1]}]},
"oak_pores": {"type": "noise", "size": 0.002, "octaves": 4, "gain": 0.6, "transform": [{"scale": [12, 1, 1]}]},
"plank_ends": {"type": "brick", "size": 1.2, "mortar": 0.0004, "colors": [[1, 1, 1], [0.1, 0.08, 0.07]],
  "transform": [{"scale": [1, 0.2, 1]}, {"rotate": {"axis": [1, 0, 0], "degrees": -90}}]},
"planks": {"type": "stripes", "size": 0.24, "share": 0.004, "colors": ["plank_ends", [0.1, 0.08, 0.07]],
  "transform": [{"rotate": {"axis": [0, 1, 0], "degrees": 90}}]},
"oak_planks": {"type": "product", "of": ["oak_rings", "planks"]},
"slab_stone": {"type": "noise", "size": 0.05, "octaves": 7, "gain": 0.6, "colors": [[0.24, 0.23, 0.21], [0.42, 0.4, 0.37]]},
"slabs": {"type": "brick", "size": 0.6, "mortar": 0.012, "colors": ["slab_stone", [0.08, 0.075, 0.07]],
  "transform": [{"rotate": {"axis": [1, 0, 0], "degrees": -90}}]},
"ripples": {"type": "noise", "size": 0.35, "octaves": 3, "transform": [{"scale": [2.5, 1, 1]}]},
"snow_crust": {"type": "noise", "size": 0.3, "octaves": 7, "gain": 0.55, "transform": [{"scale": [1, 1, 1.6]}]}
})json";

const json& presets() {
  static const json all = json::parse(table);
  return all;
}

const json& texture_presets() {
  static const json all = json::parse(texture_table);
  return all;
}

/// Collects the strings under the key "material" anywhere in a list of objects.
void find_material_names(const json& value, std::set<std::string>& names) {
  if (value.is_object())
    if (const auto found = value.find("material"); found != value.end() && found->is_string())
      names.insert(found->get<std::string>());
  if (value.is_structured())
    for (const json& member : value) find_material_names(member, names);
}

std::vector<std::string> names_of(const json& list) {
  std::vector<std::string> names;
  for (const auto& [name, preset] : list.items()) names.push_back(name);
  return names;
}

const json& section(const json& document, const char* key) {
  static const json none = json::object();
  const auto found = document.find(key);
  return found != document.end() && found->is_object() ? *found : none;
}

double unit_of(const json& document) {
  const auto unit = document.find("unit");
  return unit != document.end() && unit->is_number() ? unit->get<double>() : default_unit;
}

/// A preset's inside with lengths in the scene's unit; the scene's own index, if given, replaces the
/// preset's.
json make_medium(json inside, double unit, json& own) {
  for (json& share : inside["absorption"]) share = share.get<double>() * unit;
  if (own.contains("ior")) inside.erase("abbe");
  for (const char* key : {"ior", "abbe"})
    if (own.contains(key)) {
      inside[key] = own[key];
      own.erase(key);
    }
  return inside;
}

/// The preset in `list` that `own` names under "preset"; throws SceneError if there is none.
const json& find_preset(const json& own, const json& list, const JsonContext& context,
                        const std::string& place) {
  const JsonValue asked(own["preset"], context, place + "/preset");
  const auto preset = list.find(asked.text());
  if (preset == list.end()) {
    const std::vector<std::string> names = names_of(list);
    asked.wanted("the name of a preset (" +
                 did_you_mean(asked.text(), names, fmt::format("there is {}", fmt::join(names, ", "))) + ")");
  }
  return *preset;
}

json without_preset(json own) {
  own.erase("preset");
  return own;
}

/// Calls visit(text) for each string in a value.
void each_text(const json& value, const auto& visit) {
  if (value.is_string()) visit(value.get_ref<const std::string&>());
  if (value.is_structured())
    for (const json& member : value) each_text(member, visit);
}

/// The document's textures with their presets expanded, plus the textures that materials use.
json texture_section(const json& named, const json& materials, double unit, const JsonContext& context) {
  json section = named;
  std::set<std::string> used;
  const auto use = [&](const std::string& name) {
    if (texture_presets().contains(name) && !section.contains(name)) used.insert(name);
  };
  const auto add = [&](const std::string& name, json texture, const json& own) {
    if (texture.contains("size")) texture["size"] = texture["size"].get<double>() / unit;
    texture.update(own);
    each_text(section[name] = texture, use);
  };
  for (const auto& [name, own] : named.items())
    if (own.is_object() && own.contains("preset"))
      add(name, find_preset(own, texture_presets(), context, join_pointer("/textures", name)),
          without_preset(own));
    else
      each_text(own, use);
  each_text(materials, use);
  while (!used.empty()) {
    const std::string name = *used.begin();
    used.erase(used.begin());
    add(name, texture_presets()[name], json::object());
  }
  return section;
}

}  // namespace

json preset_sections(const json& document, const JsonContext& context) {
  if (!document.is_object()) return json::object();
  for (const char* key : {"materials", "media", "textures"})  // reading reports the error
    if (document.contains(key) && !document[key].is_object()) return json::object();
  const json &named = section(document, "materials"), &textures = section(document, "textures");
  const double unit = unit_of(document);
  json materials = named, media = section(document, "media");
  const auto add = [&](const std::string& name, json own, const json& preset) {
    json material = preset;
    if (preset.contains("inside") && !own.contains("medium")) {
      const json medium = make_medium(preset["inside"], unit, own);
      if (!media.contains(name)) media[name] = medium;
      material["medium"] = name;
    }
    material.erase("inside");
    if (own.contains("medium")) material.erase("ior"), material.erase("abbe");
    if (material.contains("bump"))
      material["bump"]["height"] = material["bump"]["height"].get<double>() / unit;
    material.update(own);
    materials[name] = material;
  };
  for (const auto& [name, own] : named.items())
    if (own.is_object() && own.contains("preset"))
      add(name, without_preset(own), find_preset(own, presets(), context, join_pointer("/materials", name)));
  std::set<std::string> used;
  if (const auto objects = document.find("objects"); objects != document.end())
    find_material_names(*objects, used);
  for (const std::string& name : used)
    if (const auto preset = presets().find(name); preset != presets().end() && !named.contains(name))
      add(name, json::object(), *preset);
  json sections = json::object();
  if (json with = texture_section(textures, materials, unit, context); with != textures)
    sections["textures"] = std::move(with);
  if (materials != named) sections.update({{"materials", materials}, {"media", media}});
  return sections;
}

std::vector<std::string> preset_names() { return names_of(presets()); }
std::vector<std::string> texture_preset_names() { return names_of(texture_presets()); }

}  // namespace sundog
