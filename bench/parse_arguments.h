// The command lines of these programs.
#pragma once
#include <CLI/CLI.hpp>
#include <cstdlib>

#include "base/arguments.h"

namespace sundog {

/// Reads the command line, or prints help or an error and ends the program.
inline void parse_or_exit(Arguments& arguments, int argc, const char* const* argv) {
  try {
    arguments.parser().parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    std::exit(arguments.parser().exit(error));
  }
}

}  // namespace sundog
