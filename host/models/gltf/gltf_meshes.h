// Converts glTF's meshes; the primitives of each are merged.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "models/gltf/gltf_accessors.h"
#include "models/gltf/gltf_materials.h"
#include "models/model.h"

namespace sundog::models {

/// How a node shapes its mesh.
struct Deformation {
  std::vector<double> weights;  // of the morph targets; empty: the mesh's own
  std::vector<dmat4> joints;    // from the bind pose to the world; empty: no skin
};

/// Whose deformation of a mesh it is: all nodes of a skin share one, unless they have weights of their own.
struct Deformed {
  std::size_t mesh = 0;
  std::optional<std::size_t> skin{}, node{};
  auto operator<=>(const Deformed&) const = default;
};

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
  /// The weights of the mesh's morph targets where a node has none; as many as it has targets.
  const std::vector<double>& weights(std::size_t index) const { return meshes_.at(index).weights; }
  /// use() for the mesh as deformed, with joints in world space.
  int use_deformed(const Deformed& which, const Deformation& deformation, Model& model);
  /// Makes later calls of use_deformed() replace the meshes that it has added.
  void deform_anew();

 private:
  struct Target {
    std::optional<std::size_t> position, normal, tangent;
  };
  struct Primitive {
    std::string pointer;
    std::optional<std::size_t> position, normal, tangent, color, indices, joints, weights;
    std::vector<std::optional<std::size_t>> uvs;  // by set
    std::vector<Target> targets;
    std::size_t material = 0;
    std::uint64_t mode = 4;
  };
  struct Entry {
    std::string name;
    std::vector<Primitive> primitives;
    std::vector<double> weights;  // one for each morph target
    std::optional<int> used;
  };
  Primitive read_primitive(const JsonAt& at) const;
  static std::vector<double> read_weights(const JsonAt& at, const Entry& entry);
  std::vector<Target> read_targets(const JsonAt& at, const Primitive& primitive) const;
  std::optional<std::size_t> read_attribute(const JsonAt& attributes, const char* name,
                                            std::string_view rule = {}) const;
  std::optional<std::size_t> read_four(const JsonAt& attributes, const char* name, std::size_t count) const;
  void check_indices(const JsonAt& at, const Accessor& accessor) const;
  int add(std::size_t index, const Deformation& deformation, Model& model);
  Mesh build(const Entry& entry, const Deformation& deformation, Model& model);
  std::vector<std::uint32_t> vertex_numbers(const Primitive& primitive);
  /// An element of an accessor; `otherwise` if it is NaN, which is counted.
  template <class Vector>
  Vector number_or(const std::vector<float>& values, std::size_t stride, std::size_t index,
                   const Vector& otherwise);
  void append_tangents(const Primitive& primitive, const std::vector<std::uint32_t>& used, Mesh& mesh);
  void append_uvs(const Primitive& primitive, const std::vector<std::uint32_t>& used, Mesh& mesh);
  void deform(const Primitive& primitive, const Deformation& deformation,
              const std::vector<std::uint32_t>& used, std::size_t first, Mesh& mesh);
  void append(const Primitive& primitive, const Deformation& deformation, Model& model, Mesh& mesh,
              std::vector<bool>& has_normal);

  GltfAccessors& accessors_;
  GltfMaterials& materials_;
  double crease_degrees_;
  bool quantized_;  // KHR_mesh_quantization
  std::vector<Entry> meshes_;
  struct Added {
    int mesh = -1;
    bool done = false;
  };
  std::map<Deformed, Added> deformed_;
  std::size_t of_no_number_ = 0;  // NaN attributes in the current mesh
};

}  // namespace sundog::models
