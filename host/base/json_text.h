// Writes JSON as text. nlohmann's dump() throws for bytes that are not UTF-8, as file names may contain.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace sundog {

/// Indents by `indent` spaces; if negative, writes one line. Bytes that are not UTF-8 become U+FFFD.
std::string json_text(const nlohmann::json& value, int indent = -1);

}  // namespace sundog
