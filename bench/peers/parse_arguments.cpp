// See parse_arguments.h.
#include "parse_arguments.h"

#include <CLI/CLI.hpp>
#include <cstdlib>

#include "base/arguments.h"

namespace sundog {

void parse_or_exit(Arguments& arguments, int argc, const char* const* argv) {
  try {
    arguments.parser().parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    std::exit(arguments.parser().exit(error));
  }
}

}  // namespace sundog
