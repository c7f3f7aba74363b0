// Parses the factors of light groups, as typed for `mix --light` and sent by the viewer's page.
#pragma once
#include <glm/glm.hpp>
#include <string>
#include <utility>

namespace sundog {

/// Parses NAME=FACTOR, NAME=#RRGGBB or NAME=FACTOR,#RRGGBB (FACTOR 0..1e6). Returns the group's name and
/// linear factor. Throws UsageError.
std::pair<std::string, glm::vec3> parse_light(const std::string& typed);

}  // namespace sundog
