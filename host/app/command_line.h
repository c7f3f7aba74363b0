// Parses sundog's command line into one of its commands.
#pragma once
#include "app/options/command.h"

namespace sundog {

/// Throws UsageError. Reads the environment variable SUNDOG_DEVICE (SPECs separated by commas).
Command parse_command_line(int argc, const char* const* argv);

}  // namespace sundog
