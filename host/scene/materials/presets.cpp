#include "scene/materials/presets.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>
#include <set>

#include "base/names.h"

namespace sundog {
using nlohmann::json;

namespace {

// A material each; "inside" is its medium, with lengths in metres. Sources:
// indices of glasses, water, ice and diamond: spectra/refraction.cpp; of plastics: Sultanova and others 2009;
// of drinks: by their sugar (ICUMSA) and alcohol (CRC Handbook). Absorption of water: Pope and Fry 1997; ice:
// Warren and Brandt 2008; beer, wine, juice, cola: Narasimhan and others 2006; whisky: by eye. The rest, and
// the colours of metals (indices by Palik and others) and matte surfaces: physicallybased.info (CC0).
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

const json& presets() {
  static const json all = json::parse(table);
  return all;
}

/// The strings under the key "material" anywhere in a list of objects.
void find_material_names(const json& value, std::set<std::string>& names) {
  if (value.is_object())
    if (const auto found = value.find("material"); found != value.end() && found->is_string())
      names.insert(found->get<std::string>());
  if (value.is_structured())
    for (const json& member : value) find_material_names(member, names);
}

json section(const json& document, const char* key) {
  const auto found = document.find(key);
  return found != document.end() && found->is_object() ? *found : json::object();
}

double unit_of(const json& document) {
  const auto unit = document.find("unit");
  return unit != document.end() && unit->is_number() ? unit->get<double>() : default_unit;
}

/// The inside of a preset, its lengths in the scene's unit, with an index that the scene gives.
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

}  // namespace

json preset_sections(const json& document, const JsonContext& context) {
  json sections = json::object();
  if (!document.is_object()) return sections;
  const json named = section(document, "materials");
  const auto add = [&](const std::string& name, json own, const json& preset) {
    if (sections.empty()) sections = {{"materials", named}, {"media", section(document, "media")}};
    json material = preset;
    if (preset.contains("inside") && !own.contains("medium")) {
      const json medium = make_medium(preset["inside"], unit_of(document), own);
      if (!sections["media"].contains(name)) sections["media"][name] = medium;
      material["medium"] = name;
    }
    material.erase("inside");
    if (own.contains("medium")) material.erase("ior"), material.erase("abbe");
    material.update(own);
    sections["materials"][name] = material;
  };
  for (const auto& [name, own] : named.items()) {
    if (!own.is_object() || !own.contains("preset")) continue;
    const JsonValue asked(own["preset"], context, join_pointer("/materials", name) + "/preset");
    const auto preset = presets().find(asked.text());
    if (preset == presets().end())
      asked.wanted("the name of a preset (" +
                   did_you_mean(asked.text(), preset_names(),
                                fmt::format("there is {}", fmt::join(preset_names(), ", "))) +
                   ")");
    json others = own;
    others.erase("preset");
    add(name, others, *preset);
  }
  std::set<std::string> used;
  if (const auto objects = document.find("objects"); objects != document.end())
    find_material_names(*objects, used);
  for (const std::string& name : used)
    if (const auto preset = presets().find(name); preset != presets().end() && !named.contains(name))
      add(name, json::object(), *preset);
  return sections;
}

std::vector<std::string> preset_names() {
  std::vector<std::string> names;
  for (const auto& [name, preset] : presets().items()) names.push_back(name);
  return names;
}

}  // namespace sundog
