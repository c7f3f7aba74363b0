// Sets OpenPBR's values extension by extension; rewrites specular-glossiness in the JSON document, before
// materials are read.
#include "models/gltf/gltf_layers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

namespace sundog::models {
namespace {

constexpr std::array layered_extensions{"KHR_materials_sheen", "KHR_materials_iridescence",
                                        "KHR_materials_anisotropy", "KHR_materials_clearcoat"};

void add_sheen(const JsonAt& at, OpenPbr& values) {
  const glm::dvec3 color = at.vector("sheenColorFactor", glm::dvec3(0), unit_range);
  const double greatest = std::max({color.x, color.y, color.z});
  if (greatest == 0) return;
  values.fuzz_weight = greatest;
  values.fuzz_color = color / greatest;
  values.fuzz_roughness = at.number("sheenRoughnessFactor", 0, unit_range);
}

void add_film(const JsonAt& at, OpenPbr& values) {
  values.thin_film_weight = at.number("iridescenceFactor", 0, unit_range);
  values.thin_film_ior = std::clamp(at.number("iridescenceIor", 1.3, not_negative), 1.0, 3.0);
  values.thin_film_thickness =
      std::min(at.number("iridescenceThicknessMaximum", 400, not_negative) / 1000, 100.0);
}

/// Converts the widths to OpenPBR's roughness and anisotropy.
void add_anisotropy(const JsonAt& at, OpenPbr& values) {
  const double strength = at.number("anisotropyStrength", 0, unit_range);
  const double across = values.specular_roughness * values.specular_roughness;
  const double along = std::lerp(across, 1.0, strength * strength);
  if (along > 0) values.specular_roughness_anisotropy = 1 - across / along;
  values.specular_roughness = std::min(std::sqrt(std::sqrt((along * along + across * across) / 2)), 1.0);
  values.geometry_tangent =
      std::remainder(at.number("anisotropyRotation", 0, {}) * 180 / std::numbers::pi, 360);
}

/// Converts KHR_materials_specular, which does not affect metals, to OpenPBR's weight and colour, which do:
/// for partly metallic bases the weight becomes part of the index.
void add_specular(const JsonAt& at, OpenPbr& values) {
  const glm::dvec3 color = at.vector("specularColorFactor", glm::dvec3(1), not_negative);
  const double most = std::max({color.x, color.y, color.z, 1.0}),
               weight = std::min(most * at.number("specularFactor", 1, unit_range), 10.0);
  if (values.base_metalness == 1) return;
  values.specular_color = color / most;
  if (values.base_metalness == 0) {
    values.specular_weight = weight;
    return;
  }
  const double root = (values.specular_ior - 1) / (values.specular_ior + 1),
               weighted = std::sqrt(std::min(weight * root * root, 0.25));
  values.specular_ior = (1 + weighted) / (1 - weighted);
}

void add_gltf_layers(const JsonAt& material, OpenPbr& values) {
  if (const auto sheen = material.extension("KHR_materials_sheen")) add_sheen(*sheen, values);
  if (const auto film = material.extension("KHR_materials_iridescence")) add_film(*film, values);
  if (const auto anisotropy = material.extension("KHR_materials_anisotropy"))
    add_anisotropy(*anisotropy, values);
  const auto coat = material.extension("KHR_materials_clearcoat");
  if (!coat) return;
  values.coat_weight = coat->number("clearcoatFactor", 0, unit_range);
  values.coat_roughness = coat->number("clearcoatRoughnessFactor", 0, unit_range);
  values.coat_ior = 1.5;
  values.coat_darkening = 0;  // the extension's coat does not darken the base
  values.coat_bends = false;
}

/// The base colour and metalness that come nearest to a diffuse and a specular colour: the metalness at
/// which the base has the brightness of both solves a quadratic equation.
MetalRough metal_of(const glm::dvec3& diffuse, const glm::dvec3& specular) {
  constexpr double plain = 0.04;
  const auto brightness = [](const glm::dvec3& c) {
    return std::sqrt(glm::dot(c * c, glm::dvec3(0.299, 0.587, 0.114)));
  };
  const double left = (1 - std::max({specular.x, specular.y, specular.z})) / (1 - plain),
               shine = brightness(specular), b = brightness(diffuse) * left + shine - 2 * plain,
               root = std::sqrt(std::max(b * b + 4 * plain * (shine - plain), 0.0)),
               metal = shine < plain ? 0 : std::clamp((root - b) / (2 * plain), 0.0, 1.0);
  const glm::dvec3 of_matte = diffuse * left / std::max(1 - metal, 1e-6),
                   of_metal = (specular - plain * (1 - metal)) / std::max(metal, 1e-6);
  return {.base = glm::clamp(glm::mix(of_matte, of_metal, metal * metal), 0.0, 1.0), .metalness = metal};
}

nlohmann::json listed(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

}  // namespace

void convert_specular_glossiness(const Source& source, nlohmann::json& document) {
  const std::vector<JsonAt> materials = JsonAt(source, document, "").list("materials");
  for (std::size_t i = 0; i < materials.size(); ++i) {
    const auto at = materials[i].extension("KHR_materials_pbrSpecularGlossiness");
    if (!at) continue;
    const auto factor = at->find("diffuseFactor");
    const std::vector<double> rgba = factor ? factor->numbers(4, unit_range) : std::vector<double>(4, 1);
    const glm::dvec3 diffuse(rgba[0], rgba[1], rgba[2]),
        specular = at->vector("specularFactor", glm::dvec3(1), unit_range);
    const double glossiness = at->number("glossinessFactor", 1, unit_range);
    nlohmann::json& extensions = document["materials"][i]["extensions"];
    const nlohmann::json stated = extensions["KHR_materials_pbrSpecularGlossiness"];
    MetalRough values = metal_of(diffuse, specular);
    nlohmann::json pbr = {{"roughnessFactor", 1 - glossiness}};
    if (at->find("specularGlossinessTexture")) {
      const nlohmann::json& texture = stated["specularGlossinessTexture"];
      const double most = std::clamp(std::max({specular.x, specular.y, specular.z}), 1e-4, 0.99);
      values = {.base = diffuse, .metalness = 0};
      pbr = {{"roughnessFactor", 1}, {"metallicRoughnessTexture", texture}};
      extensions["KHR_materials_ior"] = {{"ior", (1 + std::sqrt(most)) / (1 - std::sqrt(most))}};
      extensions["KHR_materials_specular"] = {{"specularColorFactor", listed(specular / most)},
                                              {"specularColorTexture", texture}};
    }
    pbr["baseColorFactor"] = {values.base.x, values.base.y, values.base.z, rgba[3]};
    pbr["metallicFactor"] = values.metalness;
    if (at->find("diffuseTexture")) pbr["baseColorTexture"] = stated["diffuseTexture"];
    document["materials"][i]["pbrMetallicRoughness"] = pbr;
  }
}

bool has_layers(const JsonAt& material) {
  const auto pbr = material.find("pbrMetallicRoughness");
  if (pbr && pbr->find("metallicRoughnessTexture")) return false;
  const auto transmission = material.extension("KHR_materials_transmission");
  if (transmission && transmission->find("transmissionTexture")) return false;
  if (material.extension("KHR_materials_unlit")) return false;
  const auto coat = material.extension("KHR_materials_clearcoat");
  if (coat && coat->find("clearcoatTexture")) return false;
  return std::ranges::any_of(layered_extensions,
                             [&](const char* name) { return material.extension(name).has_value(); });
}

OpenPbr gltf_openpbr(const JsonAt& material, const MetalRough& base, double ior) {
  OpenPbr values{.base_color = base.base, .base_metalness = base.metalness};
  values.specular_roughness = base.roughness;
  values.specular_ior = ior < 1 ? 1.5 : ior;
  if (const auto specular = material.extension("KHR_materials_specular")) add_specular(*specular, values);
  if (const auto through = material.extension("KHR_materials_transmission"))
    values.transmission_weight = through->number("transmissionFactor", 0, unit_range);
  add_gltf_layers(material, values);
  return values;
}

void set_gltf_layers(const OpenPbr& values, double reflectance, MaterialDescription& material) {
  const MaterialDescription before = material;
  MediumDescription inside;
  set_openpbr(values, material, inside);
  material.type = before.type;
  material.coat = 0;
  material.emission = before.emission;
  material.opacity = before.opacity;
  const double through =
      values.transmission_weight * (material.textures.metalness >= 0 ? 1 : 1 - values.base_metalness);
  material.reflection = through == 0                              ? dvec3(0)
                        : before.type == MaterialType::dielectric ? dvec3(through)
                                                                  : dvec3(through * reflectance);
  material.transmission = before.transmission;
}

}  // namespace sundog::models
