// Reads NAME=FACTOR[,#RRGGBB] into a linear colour per light group.
#include "app/options/light_balance.h"

#include <fmt/format.h>

#include <optional>

#include "app/options/option_values.h"
#include "base/error.h"
#include "base/image_io.h"

namespace sundog {
namespace {

/// The linear colour of "#RRGGBB" (sRGB).
std::optional<glm::vec3> parse_color(const std::string& text) {
  if (text.size() != 7 || text[0] != '#' ||
      text.find_first_not_of("0123456789abcdefABCDEF", 1) != std::string::npos)
    return std::nullopt;
  const unsigned long rgb = std::stoul(text.substr(1), nullptr, 16);
  glm::vec3 color;
  for (int c = 0; c < 3; ++c)
    color[c] = linear_from_srgb(static_cast<float>(rgb >> (16 - 8 * c) & 255) / 255);
  return color;
}

}  // namespace

std::pair<std::string, glm::vec3> parse_light(const std::string& typed) {
  const std::size_t equals = typed.find('='), comma = typed.find(',', equals);
  const auto wanted = [&] {
    return UsageError(
        fmt::format("--light {}: wanted NAME=FACTOR, NAME=#RRGGBB or both, as in key=2,#ffddaa", typed));
  };
  if (equals == std::string::npos || equals == 0) throw wanted();
  const std::string first = typed.substr(equals + 1, comma == std::string::npos ? comma : comma - equals - 1);
  const std::string last = comma == std::string::npos ? first : typed.substr(comma + 1);
  const std::string name = typed.substr(0, equals);
  glm::vec3 factor(1);
  if (!first.starts_with("#"))
    factor =
        glm::vec3(static_cast<float>(parse_real(fmt::format("--light {}:", name).c_str(), first, 0, 1e6)));
  if (last.starts_with("#") || comma != std::string::npos) {
    const auto color = parse_color(last);
    if (!color || (first.starts_with("#") && comma != std::string::npos)) throw wanted();
    factor *= *color;
  }
  return {name, factor};
}

}  // namespace sundog
