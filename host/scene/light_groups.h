// Groups of lights, by the names that lights, the environment and materials that shine give.
#pragma once
#include <string>
#include <vector>

#include "scene/description.h"

namespace sundog {

/// As many as a film has sums for; one is for lights in no group.
inline constexpr std::size_t most_light_groups = LIGHT_PART_COUNT - 1;

/// The names, sorted.
std::vector<std::string> light_groups(const SceneDescription& scene);

/// The number of the group of that name among `groups`, from 1 on; 0: none has it.
std::size_t number_of_group(const std::vector<std::string>& groups, const std::string& name);

}  // namespace sundog
