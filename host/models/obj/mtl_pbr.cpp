// Writes a glTF material in memory for GltfMaterials; PbrTextures maps its texture numbers to MTL's files.
#include "models/obj/mtl_pbr.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "models/gltf/gltf_materials.h"
#include "models/gltf/gltf_unread.h"

namespace sundog::models {
namespace {

using nlohmann::json;

/// The textures of the glTF material, by their "index".
enum : int { base_color, emission, metal_rough, sheen };

class PbrTextures final : public TextureSource {
 public:
  PbrTextures(const MtlStatements& stated, const Source& obj, MtlTextures& textures)
      : stated_(stated), obj_(obj), textures_(textures) {}

  TextureDescription read(const JsonAt& info) const override {
    TextureDescription texture;
    texture.image = static_cast<int>(info.integer_or("index", 0));
    return texture;
  }

  /// glTF has roughness in green and metalness in blue; MTL usually has a file for each.
  int use(const TextureDescription& texture, bool, Model& model) override {
    if (texture.image == base_color) return one("map_kd", true);
    if (texture.image == emission) return one("map_ke", true);
    if (texture.image == sheen) return one("map_ps", true);
    if (texture.channel == 1) return one("map_pr", false, 1);
    if (texture.channel == 2) return one("map_pm", false, 2);
    return GltfTextures::product(only(1, "map_pr", model), only(2, "map_pm", model), model);
  }

 private:
  int one(const char* key, bool srgb, int channel = -1) {
    const auto found = stated_.maps.find(key);
    if (found == stated_.maps.end()) return -1;
    MtlMap map = found->second;
    if (map.channel < 0) map.channel = channel;
    return textures_.use(map, srgb, obj_, stated_.library);
  }

  /// The texture, with the other channels replaced by 1.
  int only(int channel, const char* key, Model& model) {
    const int index = one(key, false);
    if (index < 0) return -1;
    TextureDescription& texture = model.textures[static_cast<std::size_t>(index)];
    texture.factor = glm::dvec4(0);
    texture.factor[channel] = 1;
    texture.offset = 1.0 - texture.factor;
    return index;
  }

  const MtlStatements& stated_;
  const Source& obj_;
  MtlTextures& textures_;
};

/// A number in [0, 1]; 1 if only a texture is stated.
double share(const MtlStatements& m, const char* key, const char* map, double absent) {
  const auto found = m.pbr.find(key);
  if (found == m.pbr.end()) return m.has_map(map) ? 1 : absent;
  return std::clamp(found->second, 0.0, 1.0);
}

json list(const glm::dvec3& v) { return {v.x, v.y, v.z}; }
double greatest(const glm::dvec3& v) { return std::max({v.x, v.y, v.z}); }

json extensions_of(const MtlStatements& m, double metallic) {
  json out = json::object();
  if (m.ior > 1) out["KHR_materials_ior"] = {{"ior", m.ior}};
  if (const double coat = share(m, "pc", "", 0); coat > 0)
    out["KHR_materials_clearcoat"] = {{"clearcoatFactor", coat},
                                      {"clearcoatRoughnessFactor", share(m, "pcr", "", 0)}};
  if (const double fuzz = share(m, "ps", "map_ps", 0); fuzz > 0) {
    json& added = out["KHR_materials_sheen"];
    added = {{"sheenColorFactor", list(glm::dvec3(fuzz))}, {"sheenRoughnessFactor", 0.5}};
    if (m.has_map("map_ps")) added["sheenColorTexture"] = {{"index", sheen}};
  }
  if (const double strength = share(m, "aniso", "", 0); strength > 0) {
    const auto turn = m.pbr.find("anisor");
    out["KHR_materials_anisotropy"] = {
        {"anisotropyStrength", strength},
        {"anisotropyRotation", turn == m.pbr.end() ? 0 : turn->second * 2 * std::numbers::pi}};
  }
  const double passed = m.filter ? std::min(greatest(*m.filter), 1.0) : 0;
  if (passed > 0 && (metallic < 1 || m.has_map("map_pm")))
    out["KHR_materials_transmission"] = {{"transmissionFactor", passed}};
  return out;
}

json gltf_material(const MtlStatements& m, double opacity) {
  const glm::dvec3 color = glm::min(m.diffuse.value_or(glm::dvec3(m.has_map("map_kd") ? 1 : 0.8)), 1.0);
  const double smoothness = std::sqrt(std::min(m.exponent / 1000, 1.0));
  const double metallic = share(m, "pm", "map_pm", 0);
  json pbr = {{"baseColorFactor", {color.x, color.y, color.z, opacity}},
              {"metallicFactor", metallic},
              {"roughnessFactor", share(m, "pr", "map_pr", 1 - smoothness)}};
  if (m.has_map("map_kd")) pbr["baseColorTexture"] = {{"index", base_color}};
  if (m.has_map("map_pr") || m.has_map("map_pm")) pbr["metallicRoughnessTexture"] = {{"index", metal_rough}};
  json out = {{"name", m.name}, {"pbrMetallicRoughness", pbr}, {"extensions", extensions_of(m, metallic)}};
  const glm::dvec3 light = m.emission.value_or(glm::dvec3(m.has_map("map_ke") ? 1 : 0));
  const double strength = std::max(greatest(light), 1.0);
  out["emissiveFactor"] = list(light / strength);
  out["extensions"]["KHR_materials_emissive_strength"] = {{"emissiveStrength", strength}};
  if (m.has_map("map_ke")) out["emissiveTexture"] = {{"index", emission}};
  if (opacity < 1 || m.has_map("map_d")) out["alphaMode"] = "BLEND";
  return out;
}

}  // namespace

bool has_pbr(const MtlStatements& m) {
  return m.has_map("map_pr") || m.has_map("map_pm") || m.has_map("map_ps") ||
         std::ranges::any_of(m.pbr, [](const auto& number) { return number.second != 0; });
}

int add_pbr(const MtlStatements& m, double opacity, const Source& obj, MtlTextures& textures, Model& model) {
  PbrTextures source(m, obj, textures);
  const json document = {{"materials", json::array({gltf_material(m, opacity)})}};
  find_unread(document, model);
  return GltfMaterials(JsonAt(obj, document, ""), source, model.for_paths).use(0, VertexColors::none, model);
}

}  // namespace sundog::models
