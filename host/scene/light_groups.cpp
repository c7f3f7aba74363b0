// Sorts the names; a group's number is its place from 1, lights without a group have 0.
#include "scene/light_groups.h"

#include <algorithm>
#include <set>

namespace sundog {

std::vector<std::string> light_groups(const SceneDescription& scene) {
  std::set<std::string> names{scene.environment.group};
  for (const LightDescription& light : scene.lights) names.insert(light.group);
  for (const MaterialDescription& material : scene.materials) names.insert(material.group);
  names.erase("");
  return {names.begin(), names.end()};
}

std::size_t number_of_group(const std::vector<std::string>& groups, const std::string& name) {
  const auto found = std::ranges::find(groups, name);
  return found == groups.end() ? 0 : static_cast<std::size_t>(found - groups.begin()) + 1;
}

}  // namespace sundog
