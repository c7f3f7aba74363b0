// Light groups, named by lights, the environment and emissive materials.
#pragma once
#include <string>
#include <vector>

#include "scene/description.h"

namespace sundog {

/// Maximum number of groups: the sums that a film has, minus one for the lights in no group.
inline constexpr std::size_t most_light_groups = LIGHT_PART_COUNT - 1;

/// The names of all groups, sorted.
std::vector<std::string> light_groups(const SceneDescription& scene);

/// The number of the named group among `groups`, from 1; 0: not found.
std::size_t number_of_group(const std::vector<std::string>& groups, const std::string& name);

}  // namespace sundog
