// glTF's materials as sundog's.
#pragma once
#include <map>
#include <utility>
#include <vector>

#include "scene/model.h"
#include "scene/models/gltf_json.h"

namespace sundog::models {

/// Checks all materials of a document, and adds to a model those that its triangles use.
///
/// base, metallic, roughness: F0 = 0.04 (or from KHR_materials_ior) mixed with base by metallic is the
/// highlight's colour, its Blinn exponent 2 / roughness^4 - 2. What mirrors is metallic * base * (1 -
/// roughness)^2, the rest of base scatters: a rough metal is no mirror. KHR_materials_transmission lets that
/// share of base through: with a volume (thickness above 0) as a dielectric with a medium, absorbing
/// -ln(attenuationColor) / attenuationDistance; without one as a thin pane, straight through. alphaMode BLEND
/// and MASK are thin panes, too. Textures are not read.
class GltfMaterials {
 public:
  explicit GltfMaterials(const JsonAt& root);

  std::size_t count() const { return materials_.size(); }
  /// The index in `model` of material `index` (or of the default one, for `count()`), with or without vertex
  /// colours.
  int use(std::size_t index, bool vertex_color, Model& model);

 private:
  struct Entry {
    MaterialDescription material;
    MediumDescription medium;
    bool has_medium = false;
  };
  static Entry read(const JsonAt& at);
  static void transmit(const JsonAt& at, Entry& entry, glm::dvec3 base, double ior);
  static void blend(const JsonAt& at, Entry& entry, double alpha);

  std::vector<Entry> materials_;  // and the default one at the end
  std::map<std::pair<std::size_t, bool>, int> used_;
};

}  // namespace sundog::models
