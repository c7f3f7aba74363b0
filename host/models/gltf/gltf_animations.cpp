// Moves a glTF file's nodes by its animations; the first one that moves a value wins. Cubic keys are Hermite
// splines (appendix C); rotations take the shorter way.
#include "models/gltf/gltf_animations.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

namespace sundog::models {
namespace {

glm::dquat quaternion(const glm::dvec4& v) {
  return unit_quaternion(v.x, v.y, v.z, v.w).value_or(glm::dquat(1, 0, 0, 0));
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

GltfAnimations::GltfAnimations(const JsonAt& root, GltfAccessors& accessors, std::size_t nodes) {
  for (const JsonAt& at : root.list("animations")) {
    Animation& animation = animations_.emplace_back();
    const std::string name = at.text("name");
    animation.name = name.empty() ? std::to_string(animations_.size() - 1) : name;
    const std::vector<JsonAt> samplers = at.list("samplers");
    for (const JsonAt& channel : at.list("channels"))
      if (const auto read = read_channel(channel, samplers, accessors, nodes))
        animation.channels.push_back(*read);
  }
}

/// Nothing for a target without a node, which an extension may have, and for morph weights.
std::optional<GltfAnimations::Channel> GltfAnimations::read_channel(const JsonAt& at,
                                                                    const std::vector<JsonAt>& samplers,
                                                                    GltfAccessors& accessors,
                                                                    std::size_t nodes) {
  const JsonAt target = at.member("target");
  const auto node = target.find("node");
  const std::string path = target.member("path").text();
  if (!node || path == "weights") return std::nullopt;
  Channel channel;
  channel.node = node->index(nodes, "node");
  if (path == "rotation")
    channel.path = Path::rotation;
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
  const bool turns = channel.path == Path::rotation;
  channel.times = &accessors.numbers(accessor_of(input, accessors, "SCALAR", false));
  channel.values = &accessors.numbers(accessor_of(output, accessors, turns ? "VEC4" : "VEC3", turns));
  const std::vector<float>& times = *channel.times;
  if (times.empty()) input.fail("one key or more wanted");
  if (!std::ranges::is_sorted(times)) input.fail("times that rise wanted");
  const std::size_t wanted = times.size() * (channel.between == Between::cubic ? 3 : 1);
  if (const std::size_t found = channel.values->size() / channel.components(); found != wanted)
    output.fail(fmt::format("{} values for {} keys: {} wanted", found, times.size(), wanted));
}

/// `part`: of a cubic key 0 is the slope before it, 1 its value, 2 the slope after it.
glm::dvec4 GltfAnimations::Channel::value(std::size_t key, std::size_t part) const {
  glm::dvec4 result(0);
  const std::size_t n = components(), first = n * (between == Between::cubic ? 3 * key + part : key);
  for (std::size_t c = 0; c < n; ++c) result[static_cast<int>(c)] = static_cast<double>((*values)[first + c]);
  return result;
}

glm::dvec4 GltfAnimations::Channel::at(double seconds) const {
  const auto after = std::ranges::upper_bound(*times, seconds, {}, [](float t) -> double { return t; });
  if (after == times->begin()) return value(0, 1);
  const auto key = static_cast<std::size_t>(after - times->begin()) - 1;
  const glm::dvec4 from = value(key, 1);
  if (after == times->end() || between == Between::step) return from;
  const double start = (*times)[key], length = *after - start, s = (seconds - start) / length;
  const glm::dvec4 to = value(key + 1, 1);
  if (between == Between::cubic) {
    const double s2 = s * s, s3 = s2 * s;
    return (2 * s3 - 3 * s2 + 1) * from + length * (s3 - 2 * s2 + s) * value(key, 2) +
           (3 * s2 - 2 * s3) * to + length * (s3 - s2) * value(key + 1, 0);
  }
  if (path != Path::rotation) return from + s * (to - from);
  const glm::dquat turned = glm::slerp(quaternion(from), quaternion(to), s);  // the shorter way
  return {turned.x, turned.y, turned.z, turned.w};
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
      const glm::dvec4 value = channel.at(seconds);
      node.matrix.reset();
      if (channel.path == Path::rotation)
        node.rotation = quaternion(value);
      else
        (channel.path == Path::scale ? node.scale : node.translation) = dvec3(value);
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
