// Compares textures, extensions and attributes with tables of those that are read; ignores values of
// unexpected types.
#include "models/gltf/gltf_unread.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "models/readers.h"

namespace sundog::models {
namespace {

using nlohmann::json;

/// A member, or null.
const json& member(const json& value, const char* key) {
  static const json none;
  if (!value.is_object()) return none;
  const auto found = value.find(key);
  return found == value.end() ? none : *found;
}

/// A member array, or an empty one.
const json& items(const json& value, const char* key) {
  static const json none = json::array();
  const json& found = member(value, key);
  return found.is_array() ? found : none;
}

struct Named {
  std::string_view key;
  const char* feature;
};

constexpr std::array textures{Named{"baseColorTexture", nullptr},  // supported
                              Named{"diffuseTexture", nullptr},
                              Named{"specularGlossinessTexture", "specular-glossiness mirrors with whitted"},
                              Named{"emissiveTexture", nullptr},
                              Named{"metallicRoughnessTexture", nullptr},
                              Named{"normalTexture", nullptr},
                              Named{"occlusionTexture", nullptr},
                              Named{"transmissionTexture", nullptr},
                              Named{"clearcoatTexture", nullptr},
                              Named{"clearcoatRoughnessTexture", "clearcoat textures"},
                              Named{"clearcoatNormalTexture", "clearcoat textures"},
                              Named{"sheenColorTexture", nullptr},
                              Named{"specularTexture", nullptr},
                              Named{"specularColorTexture", nullptr}};

constexpr std::array material_extensions{Named{"KHR_materials_ior", nullptr},  // supported
                                         Named{"KHR_materials_transmission", nullptr},
                                         Named{"KHR_materials_volume", nullptr},
                                         Named{"KHR_materials_emissive_strength", nullptr},  // for emission
                                         Named{"KHR_materials_sheen", "sheen"},
                                         Named{"KHR_materials_clearcoat", nullptr},
                                         Named{"KHR_materials_specular", nullptr},
                                         Named{"KHR_materials_iridescence", "iridescence"},
                                         Named{"KHR_materials_anisotropy", "anisotropy"},
                                         Named{"KHR_materials_dispersion", nullptr},
                                         Named{"KHR_materials_diffuse_transmission", "diffuse transmission"},
                                         Named{"KHR_materials_unlit", nullptr},
                                         Named{"KHR_materials_pbrSpecularGlossiness", nullptr}};

/// Extensions nest a few levels; a malicious file could nest deeply.
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

/// Only path tracing shows layers over a base that a texture varies (gltf_layers.h).
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
    const json& attributes = member(primitive, "attributes");
    if (attributes.contains("JOINTS_1")) leave_unread(model, "joints of vertices beyond four");
    if (attributes.contains("COLOR_1")) leave_unread(model, "second colours of vertices");
    for (const json& target : items(primitive, "targets"))
      if (target.is_object())
        for (const auto& [name, accessor] : target.items())
          if (name.starts_with("COLOR_") || name.starts_with("TEXCOORD_"))
            leave_unread(model, "morph targets' colours and texture coordinates");
    if (member(member(primitive, "extensions"), "KHR_materials_variants").is_object())
      leave_unread(model, "material variants");
  }
}

constexpr std::array read_extensions{"KHR_lights_punctual",   "EXT_mesh_gpu_instancing",
                                     "KHR_mesh_quantization", "KHR_texture_transform",
                                     "EXT_texture_webp",      "KHR_texture_basisu"};

/// Extensions that do not change the picture, even if the file requires them (Khronos' registry of glTF
/// extensions; EXT_structural_metadata and its kin are those of 3D Tiles): metadata, what a user may point
/// at, and coarser nodes in place of distant ones.
constexpr std::array invisible_extensions{"KHR_xmp",
                                          "KHR_xmp_json_ld",
                                          "KHR_node_hoverability",
                                          "KHR_node_selectability",
                                          "AGI_stk_metadata",
                                          "EXT_feature_metadata",
                                          "EXT_instance_features",
                                          "EXT_mesh_features",
                                          "EXT_mesh_manifold",
                                          "EXT_structural_metadata",
                                          "FB_geometry_metadata",
                                          "GODOT_single_root",
                                          "GRIFFEL_bim_data",
                                          "MSFT_lod"};

/// Extensions of materials and KHR_texture_basisu are reported where materials use them.
bool is_known(const std::string& extension) {
  return extension.starts_with("KHR_materials_") || std::ranges::count(read_extensions, extension) > 0 ||
         std::ranges::count(invisible_extensions, extension) > 0;
}

}  // namespace

void check_extensions(const JsonAt& root) {
  for (const JsonAt& at : root.list("extensionsRequired"))
    if (const std::string name = at.text(); !is_known(name))
      at.fail(fmt::format("the file requires the extension {}, which is not read", name));
}

void name_unread_extensions(const JsonAt& root, Model& model) {
  for (const JsonAt& at : root.list("extensionsUsed"))
    if (const std::string name = at.text(); !is_known(name)) leave_unread(model, name);
}

void find_unread(const json& document, Model& model) {
  for (const json& material : items(document, "materials")) find_in_material(material, model);
  for (const json& mesh : items(document, "meshes")) find_in_mesh(mesh, model);
}

}  // namespace sundog::models
