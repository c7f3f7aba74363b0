// glTF's materials as sundog's.
#pragma once
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "scene/model.h"
#include "scene/models/gltf/gltf_json.h"
#include "scene/models/gltf/gltf_textures.h"

namespace sundog::models {

/// What a primitive's COLOR_0 says.
enum class VertexColors { none, opaque, with_alpha };

/// Checks all materials of a document, and adds to a model those that its triangles use.
///
/// base, metallic, roughness: by shared/metal_rough.h, with a reflectance of 0.04 or from KHR_materials_ior
/// and _specular; KHR_materials_clearcoat adds a mirror, _unlit makes all of it emission.
/// KHR_materials_transmission lets that
/// share of base through: with a volume (thickness above 0) as a dielectric with a medium, absorbing
/// -ln(attenuationColor) / attenuationDistance; without one as a thin pane, straight through, and for
/// integrators that follow paths as a thin wall, frosted where it is rough. alphaMode BLEND and MASK become
/// the opacity. The base colour's texture is a factor on all terms that have its colour, and so are the
/// colours of vertices, whose alpha is one on the opacity. For integrators that follow paths most are
/// OpenPBR's layers in place of these terms (gltf_layers.h).
class GltfMaterials {
 public:
  GltfMaterials(const JsonAt& root, GltfTextures& textures);

  std::size_t count() const { return materials_.size(); }
  /// The index in `model` of material `index` (or of the default one, for `count()`) on primitives of such
  /// colours.
  int use(std::size_t index, VertexColors colors, Model& model);

 private:
  struct Entry {
    MaterialDescription material;
    std::optional<MaterialDescription> by_paths;  // without textures
    MediumDescription medium;
    bool has_medium = false;
    std::optional<TextureDescription> base, opacity, emission, metal_rough, normal, occlusion;
    std::optional<TextureDescription> transmission, specular, specular_color, coat, sheen;
    std::optional<TextureDescription> coat_weight, glass;  // of by_paths, which may have a medium by itself
    bool paths_have_medium = false;
    MetalRough values;
    double transmitted = 0;  // of what is no metal, the share that a transmission texture is a factor on
    bool two_sided = false, unlit = false,
         by_values = false;  // by_values: textures change metalness or roughness
    bool fades = false;      // the alpha of vertices is a factor on the opacity
  };
  Entry read(const JsonAt& at, VertexColors colors) const;
  Entry of_colors(std::size_t index, VertexColors colors) const;
  void read_textures(const JsonAt& at, Entry& entry) const;
  void settle_sides();
  static void read_unlit(const JsonAt& at, Entry& entry, glm::dvec3 base);
  std::optional<TextureDescription> read_coat_texture(const JsonAt& at) const;
  void add_sheen_texture(const JsonAt& at, Entry& entry) const;
  void add_clearcoat(const JsonAt& at, Entry& entry) const;
  void add_layers(const JsonAt& at, Entry& entry, double ior) const;
  void add_specular_textures(const JsonAt& at, Entry& entry) const;
  void use_textures(const Entry& entry, MaterialDescription& material, Model& model);
  void use_transmission(const Entry& entry, MaterialDescription& material, Model& model);
  void use_by_paths(const Entry& entry, MaterialDescription& material, Model& model);
  void use_specular(const Entry& entry, MaterialDescription& material, Model& model);
  void transmit(const JsonAt& at, Entry& entry, glm::dvec3 base, double ior) const;
  static void use_vertex_colors(const Entry& entry, MaterialDescription& material, Model& model);
  static void blend(const JsonAt& at, Entry& entry, double alpha);

  GltfTextures& textures_;
  std::vector<JsonAt> document_;
  std::vector<Entry> materials_;  // and the default one at the end
  std::map<std::pair<std::size_t, VertexColors>, int> used_;
};

}  // namespace sundog::models
