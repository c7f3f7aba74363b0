// `sundog formulas`: the surfaces that a scene can name, what they are put together with, and the language of
// a user's own.
#pragma once
#include "app/options/options.h"

namespace sundog {

class Arguments;

/// The list as an object of schema 1.
std::string formulas_json();

/// Declares the command: prints the list as text, or with --json as an object of schema 1.
void add_formulas(Arguments& root, Command& chosen);

}  // namespace sundog
