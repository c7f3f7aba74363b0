// Checks a command line before CLI11 parses it, and suggests the nearest name for a misspelt word.
#pragma once
#include <string>
#include <vector>

namespace sundog {

struct OptionWords {
  std::vector<std::string> names;  // "--out", "-o"
  bool takes_value = false;
  std::string type;  // the value's type
};

/// A command with its options and subcommands.
struct CommandWords {
  std::string name, line;  // "rays", "sundog bench rays"
  std::vector<OptionWords> options;
  std::vector<CommandWords> commands;
  bool hidden = false;  // not for users
};

/// The innermost command that the command line names. Throws UsageError for an unknown command or option, and
/// for an option without its value. `root` must outlive the result.
const CommandWords& check_words(const CommandWords& root, int argc, const char* const* argv);

/// "(see sundog bench rays --help)"
std::string see_help(const CommandWords& command);

/// Names of the commands that help lists.
std::vector<std::string> command_names(const CommandWords& parent);

}  // namespace sundog
