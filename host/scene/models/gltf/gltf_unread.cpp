// See gltf_unread.h. Whatever is not of the expected kind is passed by.
#include "scene/models/gltf/gltf_unread.h"

#include <array>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "scene/models/readers.h"

namespace sundog::models {
namespace {

using nlohmann::json;

/// The member, or null.
const json& member(const json& value, const char* key) {
  static const json none;
  if (!value.is_object()) return none;
  const auto found = value.find(key);
  return found == value.end() ? none : *found;
}

/// The items of a member that is an array; else null, which has none.
const json& items(const json& value, const char* key) {
  static const json none = json::array();
  const json& found = member(value, key);
  return found.is_array() ? found : none;
}

struct Named {
  std::string_view key;
  const char* feature;
};

constexpr std::array textures{Named{"baseColorTexture", nullptr},  // read
                              Named{"emissiveTexture", nullptr},
                              Named{"metallicRoughnessTexture", nullptr},
                              Named{"normalTexture", nullptr},
                              Named{"occlusionTexture", nullptr},
                              Named{"transmissionTexture", nullptr},
                              Named{"clearcoatTexture", nullptr},
                              Named{"clearcoatRoughnessTexture", "clearcoat textures"},
                              Named{"clearcoatNormalTexture", "clearcoat textures"},
                              Named{"specularTexture", nullptr},
                              Named{"specularColorTexture", nullptr}};

constexpr std::array material_extensions{
    Named{"KHR_materials_ior", nullptr},  // read
    Named{"KHR_materials_transmission", nullptr},
    Named{"KHR_materials_volume", nullptr},
    Named{"KHR_materials_emissive_strength", nullptr},  // of emission
    Named{"KHR_materials_sheen", "sheen"},
    Named{"KHR_materials_clearcoat", nullptr},
    Named{"KHR_materials_specular", nullptr},
    Named{"KHR_materials_iridescence", "iridescence"},
    Named{"KHR_materials_anisotropy", "anisotropy"},
    Named{"KHR_materials_dispersion", nullptr},
    Named{"KHR_materials_diffuse_transmission", "diffuse transmission"},
    Named{"KHR_materials_unlit", nullptr},
    Named{"KHR_materials_pbrSpecularGlossiness", "specular-glossiness materials"}};

/// Extensions nest a few levels; a file may nest without end.
void find_textures(const json& value, Model& model, int levels = 8) {
  if (!value.is_object() || levels == 0) return;
  for (const auto& [key, inner] : value.items()) {
    if (key == "extras") continue;
    if (key.ends_with("Texture") && inner.is_object()) {
      const char* feature = "other textures";
      for (const Named& known : textures)
        if (key == known.key) feature = known.feature;
      if (feature) leave_unread(model, feature);
    } else {
      find_textures(inner, model, levels - 1);
    }
  }
}

bool is_layer(const std::string& extension) {
  constexpr std::array layers{"KHR_materials_sheen", "KHR_materials_iridescence", "KHR_materials_anisotropy"};
  return std::ranges::count(layers, extension) > 0;
}

/// Only paths see layers where a texture varies what lies below them (gltf_layers.h).
bool is_for_paths(const json& material) {
  const json& extensions = member(material, "extensions");
  return member(member(material, "pbrMetallicRoughness"), "metallicRoughnessTexture").is_object() ||
         member(member(extensions, "KHR_materials_transmission"), "transmissionTexture").is_object() ||
         member(member(extensions, "KHR_materials_clearcoat"), "clearcoatTexture").is_object();
}

void find_in_material(const json& material, Model& model) {
  find_textures(material, model);
  const json& extensions = member(material, "extensions");
  if (!extensions.is_object()) return;
  for (const auto& [name, extension] : extensions.items()) {
    const char* feature = name.c_str();
    for (const Named& known : material_extensions)
      if (name == known.key) feature = known.feature;
    if (!feature || (is_layer(name) && !is_for_paths(material))) continue;
    leave_unread(model, is_layer(name) ? std::string(feature) + " with whitted" : feature);
  }
}

void find_in_mesh(const json& mesh, Model& model) {
  for (const json& primitive : items(mesh, "primitives")) {
    const json& mode = member(primitive, "mode");
    if (mode == 0) leave_unread(model, "points");
    if (mode == 1 || mode == 2 || mode == 3) leave_unread(model, "lines");
    if (!items(primitive, "targets").empty()) leave_unread(model, "morph targets");
    if (member(member(primitive, "extensions"), "KHR_materials_variants").is_object())
      leave_unread(model, "material variants");
  }
}

}  // namespace

void find_unread(const json& document, Model& model) {
  for (const json& material : items(document, "materials")) find_in_material(material, model);
  for (const json& mesh : items(document, "meshes")) find_in_mesh(mesh, model);
  for (const json& node : items(document, "nodes"))
    if (node.contains("skin")) leave_unread(model, "skins");
  if (!items(document, "animations").empty()) leave_unread(model, "animations");
}

}  // namespace sundog::models
