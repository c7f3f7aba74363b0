// Moves a glTF file's nodes by its animations; the first one that moves a value wins. Cubic keys are Hermite
// splines (appendix C); rotations take the shorter way.
#include "models/gltf/gltf_animations.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

namespace sundog::models {
namespace {

glm::dquat quaternion(const std::vector<double>& v) {
  return unit_quaternion(v[0], v[1], v[2], v[3]).value_or(glm::dquat(1, 0, 0, 0));
}

/// The index of an accessor of this type, with floats or, if `normalized`, normalised integers.
std::size_t accessor_of(const JsonAt& at, const GltfAccessors& accessors, std::string_view type,
                        bool normalized) {
  const std::size_t index = at.index(accessors.all().size(), "accessor");
  const Accessor& accessor = accessors.all()[index];
  if (accessor.type != type ||
      (accessor.dense.component != component_float && !(normalized && accessor.normalized)))
    at.fail(fmt::format("accessor {} is a {} of type {}: {} of floats{} wanted", index, accessor.type,
                        accessor.dense.component, type, normalized ? " or normalised integers" : ""));
  return index;
}

}  // namespace

std::optional<glm::dquat> unit_quaternion(double x, double y, double z, double w) {
  const double length = std::sqrt(x * x + y * y + z * z + w * w);
  if (!(length > 1e-6)) return std::nullopt;
  return glm::dquat(w / length, x / length, y / length, z / length);
}

std::vector<std::string> animation_names(const nlohmann::json& document) {
  std::vector<std::string> names;
  const auto list = document.find("animations");
  if (list == document.end() || !list->is_array()) return names;
  for (const nlohmann::json& animation : *list) {
    const bool named = animation.is_object() && animation.contains("name") && animation["name"].is_string();
    names.push_back(named ? animation["name"].get<std::string>() : std::to_string(names.size()));
  }
  return names;
}

std::set<std::size_t> nodes_with_moving_weights(const nlohmann::json& document) {
  const nlohmann::json none;
  const auto member = [&](const nlohmann::json& value, const char* key) -> const nlohmann::json& {
    const auto found = value.find(key);
    return found == value.end() ? none : *found;
  };
  std::set<std::size_t> nodes;
  for (const nlohmann::json& animation : member(document, "animations"))
    for (const nlohmann::json& channel : member(animation, "channels"))
      if (const auto& target = member(channel, "target"); member(target, "path") == "weights")
        if (const auto& node = member(target, "node"); node.is_number_unsigned())
          nodes.insert(node.get<std::size_t>());
  return nodes;
}

GltfAnimations::GltfAnimations(const JsonAt& root, GltfAccessors& accessors,
                               const std::vector<std::size_t>& targets) {
  for (const JsonAt& at : root.list("animations")) {
    Animation& animation = animations_.emplace_back();
    const std::string name = at.text("name");
    animation.name = name.empty() ? std::to_string(animations_.size() - 1) : name;
    const std::vector<JsonAt> samplers = at.list("samplers");
    for (const JsonAt& channel : at.list("channels"))
      if (const auto read = read_channel(channel, samplers, accessors, targets))
        animation.channels.push_back(*read);
  }
}

/// Nothing for a target without a node, which an extension may have, and for weights of no morph targets.
std::optional<GltfAnimations::Channel> GltfAnimations::read_channel(const JsonAt& at,
                                                                    const std::vector<JsonAt>& samplers,
                                                                    GltfAccessors& accessors,
                                                                    const std::vector<std::size_t>& targets) {
  const JsonAt target = at.member("target");
  const auto node = target.find("node");
  const std::string path = target.member("path").text();
  if (!node) return std::nullopt;
  Channel channel;
  channel.node = node->index(targets.size(), "node");
  if (path == "weights" && targets[channel.node] == 0) return std::nullopt;
  if (path == "rotation")
    channel.path = Path::rotation, channel.components = 4;
  else if (path == "weights")
    channel.path = Path::weights, channel.components = targets[channel.node];
  else if (path == "scale")
    channel.path = Path::scale;
  else if (path != "translation")
    target.member("path").fail("translation, rotation, scale or weights wanted");
  read_sampler(samplers[at.member("sampler").index(samplers.size(), "sampler")], accessors, channel);
  return channel;
}

void GltfAnimations::read_sampler(const JsonAt& at, GltfAccessors& accessors, Channel& channel) {
  const std::string between = at.text("interpolation");
  if (between == "STEP")
    channel.between = Between::step;
  else if (between == "CUBICSPLINE")
    channel.between = Between::cubic;
  else if (!between.empty() && between != "LINEAR")
    at.member("interpolation").fail("LINEAR, STEP or CUBICSPLINE wanted");
  const JsonAt input = at.member("input"), output = at.member("output");
  const bool turns = channel.path == Path::rotation, morphs = channel.path == Path::weights;
  const char* type = turns ? "VEC4" : morphs ? "SCALAR" : "VEC3";
  channel.times = &accessors.numbers(accessor_of(input, accessors, "SCALAR", false));
  channel.values = &accessors.numbers(accessor_of(output, accessors, type, turns || morphs));
  const std::vector<float>& times = *channel.times;
  if (times.empty()) input.fail("one key or more wanted");
  if (!std::ranges::is_sorted(times)) input.fail("times that rise wanted");
  const std::size_t each = morphs ? channel.components : 1;
  const std::size_t wanted = each * times.size() * (channel.between == Between::cubic ? 3 : 1);
  if (const std::size_t found = each * channel.values->size() / channel.components; found != wanted)
    output.fail(fmt::format("{} values for {} keys: {} wanted", found, times.size(), wanted));
}

/// `part`: of a cubic key 0 is the slope before it, 1 its value, 2 the slope after it.
double GltfAnimations::Channel::value(std::size_t key, std::size_t part, std::size_t component) const {
  const std::size_t element = between == Between::cubic ? 3 * key + part : key;
  return static_cast<double>((*values)[components * element + component]);
}

std::vector<double> GltfAnimations::Channel::at(double seconds) const {
  const auto after = std::ranges::upper_bound(*times, seconds, {}, [](float t) -> double { return t; });
  const auto key = static_cast<std::size_t>(std::max(after - times->begin(), std::ptrdiff_t{1})) - 1;
  std::vector<double> from(components), to(components);
  for (std::size_t c = 0; c < components; ++c) from[c] = value(key, 1, c);
  if (after == times->begin() || after == times->end() || between == Between::step) return from;
  const double start = (*times)[key], length = *after - start, s = (seconds - start) / length;
  for (std::size_t c = 0; c < components; ++c) to[c] = value(key + 1, 1, c);
  if (path == Path::rotation && between == Between::linear) {
    const glm::dquat turned = glm::slerp(quaternion(from), quaternion(to), s);  // the shorter way
    return {turned.x, turned.y, turned.z, turned.w};
  }
  const double s2 = s * s, s3 = s2 * s;
  for (std::size_t c = 0; c < components; ++c)
    from[c] = between == Between::linear
                  ? from[c] + s * (to[c] - from[c])
                  : (2 * s3 - 3 * s2 + 1) * from[c] + length * (s3 - 2 * s2 + s) * value(key, 2, c) +
                        (3 * s2 - 2 * s3) * to[c] + length * (s3 - s2) * value(key + 1, 0, c);
  return from;
}

double GltfAnimations::time_of(const Playing& playing) const {
  double first = std::numeric_limits<double>::infinity(), last = -first;
  for (const Animation& animation : animations_)
    if (playing.animation.empty() || animation.name == playing.animation)
      for (const Channel& channel : animation.channels) {
        first = std::min(first, static_cast<double>(channel.times->front()));
        last = std::max(last, static_cast<double>(channel.times->back()));
      }
  const double length = last - first;
  if (!playing.cycle || !(length > 0)) return playing.seconds;
  return playing.seconds - std::floor((playing.seconds - first) / length) * length;
}

void GltfAnimations::move(const Playing& playing, std::vector<NodePose>& nodes) const {
  const double seconds = time_of(playing);
  for (std::size_t i = animations_.size(); i-- > 0;) {
    if (!playing.animation.empty() && animations_[i].name != playing.animation) continue;
    for (const Channel& channel : animations_[i].channels) {
      NodePose& node = nodes[channel.node];
      const std::vector<double> value = channel.at(seconds);
      if (channel.path == Path::weights) {
        node.weights = value;
        continue;
      }
      node.matrix.reset();
      if (channel.path == Path::rotation)
        node.rotation = quaternion(value);
      else
        (channel.path == Path::scale ? node.scale : node.translation) = {value[0], value[1], value[2]};
    }
  }
}

double GltfAnimations::last() const {
  double last = 0;
  for (const Animation& animation : animations_)
    for (const Channel& channel : animation.channels)
      last = std::max(last, static_cast<double>(channel.times->back()));
  return last;
}

bool GltfAnimations::compete() const {
  std::set<std::pair<std::size_t, Path>> moved;
  for (const Animation& animation : animations_) {
    std::set<std::pair<std::size_t, Path>> own;
    for (const Channel& channel : animation.channels) own.emplace(channel.node, channel.path);
    for (const auto& value : own)
      if (!moved.insert(value).second) return true;
  }
  return false;
}

}  // namespace sundog::models
