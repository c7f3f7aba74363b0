// JSON as text. nlohmann's dump() throws on bytes that are no UTF-8, which names of files and settings may
// hold.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace sundog {

/// Indented by so many blanks; on one line where it is negative. Bytes that are no UTF-8 become U+FFFD.
std::string json_text(const nlohmann::json& value, int indent = -1);

}  // namespace sundog
