// Writes JSON with replacements (json_text.h).
#include "base/json_text.h"

#include <nlohmann/json.hpp>

namespace sundog {

std::string json_text(const nlohmann::json& value, int indent) {
  return value.dump(indent, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace sundog
