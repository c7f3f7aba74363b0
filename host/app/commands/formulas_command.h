// `sundog formulas`: lists the surfaces that a scene can name, the operations that combine them, and the
// functions of the formula language.
#pragma once
#include <string>

namespace sundog {

/// The list as a JSON object of schema 1.
std::string formulas_json();

}  // namespace sundog
