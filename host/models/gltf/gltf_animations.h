// glTF's animations of nodes (glTF 2.0, section 3.11): keys, and the values between them.
#pragma once
#include <glm/gtc/quaternion.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "models/gltf/gltf_accessors.h"
#include "models/model.h"

namespace sundog::models {

/// A node's transform relative to its parent.
struct NodePose {
  std::optional<dmat4> matrix;  // replaces the other members
  dvec3 translation{0};
  glm::dquat rotation{1, 0, 0, 0};
  dvec3 scale{1};
  std::vector<double> weights;  // of its mesh's morph targets; empty: the mesh's own
};

/// The normalised quaternion; nothing for 0.
std::optional<glm::dquat> unit_quaternion(double x, double y, double z, double w);

/// The names of the document's animations; an unnamed animation gets its index. Reads nothing else.
std::vector<std::string> animation_names(const nlohmann::json& document);

/// The nodes whose morph weights an animation moves. Passes by what is malformed.
std::set<std::size_t> nodes_with_moving_weights(const nlohmann::json& document);

class GltfAnimations {
 public:
  /// Reads and checks all animations; `targets` has the number of morph targets by node. Throws SceneError.
  GltfAnimations(const JsonAt& root, GltfAccessors& accessors, const std::vector<std::size_t>& targets);

  /// Sets the nodes' poses at a time. If several animations move the same value of a node, the first one
  /// wins.
  void move(const Playing& playing, std::vector<NodePose>& nodes) const;
  /// The time of the last key.
  double last() const;
  /// Whether several animations move the same value of a node.
  bool compete() const;

 private:
  enum class Path { translation, rotation, scale, weights };
  enum class Between { linear, step, cubic };
  struct Channel {
    std::size_t node = 0;
    Path path = Path::translation;
    Between between = Between::linear;
    const std::vector<float>*times = nullptr, *values = nullptr;  // of the accessors
    std::size_t components = 3;
    double value(std::size_t key, std::size_t part, std::size_t component) const;
    std::vector<double> at(double seconds) const;
  };
  struct Animation {
    std::string name;
    std::vector<Channel> channels;
  };
  static std::optional<Channel> read_channel(const JsonAt& at, const std::vector<JsonAt>& samplers,
                                             GltfAccessors& accessors,
                                             const std::vector<std::size_t>& targets);
  static void read_sampler(const JsonAt& at, GltfAccessors& accessors, Channel& channel);
  double time_of(const Playing& playing) const;

  std::vector<Animation> animations_;
};

}  // namespace sundog::models
