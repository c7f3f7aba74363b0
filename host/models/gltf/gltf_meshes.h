// Converts glTF's meshes; the primitives of each are merged.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "models/gltf/gltf_accessors.h"
#include "models/gltf/gltf_materials.h"
#include "models/model.h"

namespace sundog::models {

class GltfMeshes {
 public:
  /// Validates all meshes of the document; decodes none.
  GltfMeshes(const JsonAt& root, GltfAccessors& accessors, GltfMaterials& materials, double crease_degrees);

  std::size_t count() const { return meshes_.size(); }
  const std::string& name(std::size_t mesh) const { return meshes_[mesh].name; }
  /// The index in `model` of a mesh, added at its first use; -1 if it has no triangles (points, lines).
  int use(std::size_t index, Model& model);
  /// Whether the mesh's vertices have joints, which then replace its node's transform.
  bool has_joints(std::size_t index) const;
  /// use() for the mesh as `skin` deforms it, in world space; `joints` are world matrices.
  int use_skinned(std::size_t index, std::size_t skin, const std::vector<dmat4>& joints, Model& model);
  /// Makes later calls of use_skinned() replace the meshes that it has added.
  void skin_anew();

 private:
  struct Primitive {
    std::string pointer;
    std::optional<std::size_t> position, normal, tangent, color, indices, joints, weights;
    std::vector<std::optional<std::size_t>> uvs;  // by set
    std::size_t material = 0;
    std::uint64_t mode = 4;
  };
  struct Entry {
    std::string name;
    std::vector<Primitive> primitives;
    std::optional<int> used;
  };
  Primitive read_primitive(const JsonAt& at) const;
  std::optional<std::size_t> read_attribute(const JsonAt& attributes, const char* name) const;
  std::optional<std::size_t> read_four(const JsonAt& attributes, const char* name, std::size_t count) const;
  void check_indices(const JsonAt& at, const Accessor& accessor) const;
  int add(std::size_t index, const std::vector<dmat4>& joints, Model& model);
  Mesh build(const Entry& entry, const std::vector<dmat4>& joints, Model& model);
  std::vector<std::uint32_t> vertex_numbers(const Primitive& primitive);
  /// An element of an accessor; `otherwise` if it is NaN, which is counted.
  template <class Vector>
  Vector number_or(const std::vector<float>& values, std::size_t stride, std::size_t index,
                   const Vector& otherwise);
  void append_tangents(const Primitive& primitive, const std::vector<std::uint32_t>& used, Mesh& mesh);
  void append_uvs(const Primitive& primitive, const std::vector<std::uint32_t>& used, Mesh& mesh);
  void append(const Primitive& primitive, const std::vector<dmat4>& joints, Model& model, Mesh& mesh,
              std::vector<bool>& has_normal);

  GltfAccessors& accessors_;
  GltfMaterials& materials_;
  double crease_degrees_;
  bool quantized_;  // KHR_mesh_quantization
  std::vector<Entry> meshes_;
  struct Skinned {
    int mesh = -1;
    bool done = false;
  };
  std::map<std::pair<std::size_t, std::size_t>, Skinned> skinned_;  // keyed by mesh and skin
  std::size_t of_no_number_ = 0;                                    // NaN attributes in the current mesh
};

}  // namespace sundog::models
