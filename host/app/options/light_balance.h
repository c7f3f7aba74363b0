// Factors of light groups, as `mix --light` and the viewer's page write them.
#pragma once
#include <glm/glm.hpp>
#include <string>
#include <utility>

namespace sundog {

/// The group and its factor, linear: NAME=FACTOR, NAME=#RRGGBB or NAME=FACTOR,#RRGGBB, with a factor of 0 to
/// 1e6. Throws UsageError.
std::pair<std::string, glm::vec3> parse_light(const std::string& typed);

}  // namespace sundog
