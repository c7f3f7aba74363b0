// The command lines of these programs.
#pragma once

namespace sundog {

class Arguments;

/// Reads the command line, or prints help or an error and ends the program.
void parse_or_exit(Arguments& arguments, int argc, const char* const* argv);

}  // namespace sundog
