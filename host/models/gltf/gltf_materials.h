// Converts glTF's materials.
#pragma once
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "models/gltf/gltf_json.h"
#include "models/gltf/gltf_textures.h"
#include "models/model.h"

namespace sundog::models {

/// The content of a primitive's COLOR_0.
enum class VertexColors { none, opaque, with_alpha };

/// Validates all materials of a document, and adds those that triangles use to a model.
///
/// base, metallic, roughness: by plain/shade/lowering.h, with a reflectance of 0.04 or from KHR_materials_ior
/// and _specular. KHR_materials_clearcoat adds a mirror, _unlit turns everything into emission.
/// KHR_materials_transmission transmits that share of the base: with a volume (thickness above 0), through a
/// dielectric with a medium that absorbs -ln(attenuationColor) / attenuationDistance; without one, through a
/// thin pane, unrefracted, which path tracing replaces by a thin wall, frosted if rough. alphaMode BLEND and
/// MASK set the opacity. The base colour texture multiplies all terms of that colour, as do vertex colours,
/// whose alpha multiplies the opacity. Path tracing uses OpenPBR layers for most materials (gltf_layers.h).
class GltfMaterials {
 public:
  GltfMaterials(const JsonAt& root, TextureSource& textures, bool for_paths);

  std::size_t count() const { return materials_.size(); }
  /// The index in `model` of material `index` (`count()`: the default one) on primitives with such vertex
  /// colours.
  int use(std::size_t index, VertexColors colors, Model& model);

 private:
  struct Entry {
    MaterialDescription material;
    std::optional<MaterialDescription> by_paths;  // replaces `material` along paths; without textures
    MediumDescription medium;
    bool has_medium = false;
    std::optional<TextureDescription> base, opacity, emission, metal_rough, normal, occlusion;
    std::optional<TextureDescription> transmission, specular, specular_color, coat, sheen;
    std::optional<TextureDescription> coat_weight, glass;  // for by_paths, which may have its own medium
    bool paths_have_medium = false;
    MetalRough values;
    double transmitted = 0;  // share of the non-metal; multiplied by the transmission texture
    bool two_sided = false, unlit = false,
         by_values = false;  // textures change metalness or roughness
    bool fades = false;      // vertex alpha multiplies the opacity
  };
  Entry read(const JsonAt& at, VertexColors colors) const;
  Entry of_colors(std::size_t index, VertexColors colors) const;
  void read_textures(const JsonAt& at, Entry& entry) const;
  std::optional<TextureDescription> read_texture(const std::optional<JsonAt>& of, const char* name,
                                                 int channel = -1) const;
  void settle_sides();
  static void read_unlit(const JsonAt& at, Entry& entry, glm::dvec3 base);
  std::optional<TextureDescription> read_coat_texture(const JsonAt& at) const;
  void add_clearcoat(const JsonAt& at, Entry& entry) const;
  void add_layers(const JsonAt& at, Entry& entry, double ior) const;
  void add_specular_textures(const JsonAt& at, Entry& entry) const;
  void use_textures(const Entry& entry, MaterialDescription& material, Model& model);
  void use_transmission(const Entry& entry, MaterialDescription& material, Model& model);
  MaterialDescription use_by_paths(const Entry& entry, const MaterialDescription& material, Model& model);
  void use_specular(const Entry& entry, MaterialDescription& material, Model& model);
  void transmit(const JsonAt& at, Entry& entry, glm::dvec3 base, double ior) const;
  static void use_vertex_colors(const Entry& entry, MaterialDescription& material, Model& model);
  static void blend(const JsonAt& at, Entry& entry, double alpha);

  TextureSource& textures_;
  bool for_paths_;
  std::vector<JsonAt> document_;
  std::vector<Entry> materials_;  // the default one is last
  std::map<std::pair<std::size_t, VertexColors>, int> used_;
};

}  // namespace sundog::models
