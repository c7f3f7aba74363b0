// `sundog formulas`: the surfaces that a scene can name, what they are put together with, and the language of
// a user's own.
#pragma once
#include <string>

namespace sundog {

/// The list as an object of schema 1.
std::string formulas_json();

}  // namespace sundog
