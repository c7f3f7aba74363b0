// The words of a command line, before the library of options reads it: misspelt ones are answered by the
// nearest.
#pragma once
#include <string>
#include <vector>

namespace sundog {

struct OptionWords {
  std::vector<std::string> names;  // "--out", "-o"
  bool takes_value = false;
  std::string type;  // of the value
};

/// A command with its options, and the commands in it.
struct CommandWords {
  std::string name, line;  // "rays", "sundog bench rays"
  std::vector<OptionWords> options;
  std::vector<CommandWords> commands;
  bool hidden = false;  // not for people
};

/// The innermost command that the line names. Throws UsageError for an unknown command or option, and for an
/// option whose value is missing. `root` must outlive the result.
const CommandWords& check_words(const CommandWords& root, int argc, const char* const* argv);

/// "(see sundog bench rays --help)"
std::string see_help(const CommandWords& command);

/// Names of the commands that help lists.
std::vector<std::string> command_names(const CommandWords& parent);

}  // namespace sundog
