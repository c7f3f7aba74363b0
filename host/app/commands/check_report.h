// The text report of `sundog check`.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace sundog {

/// The binary cache and the tuning results: folder, files, bytes, whether it can be written.
nlohmann::json cache_figures();

/// The report for people, from the one for programs.
std::string check_text(const nlohmann::json& report);

}  // namespace sundog
