// Descends the tree of commands word by word, then checks that each option is known and not followed by
// another option in place of its value.
#include "app/options/command_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "base/error.h"
#include "base/names.h"

namespace sundog {
namespace {

/// A command, and the index of the argument after its name.
struct NamedCommand {
  const CommandWords* words;
  int next;
};

NamedCommand find_command(const CommandWords& root, int argc, const char* const* argv) {
  NamedCommand named{&root, 1};
  while (true) {
    const bool given = named.next < argc;
    const std::string wanted = given ? argv[named.next] : "";
    const std::vector<CommandWords>& inner = named.words->commands;
    if (inner.empty() || wanted.starts_with('-')) return named;
    const auto found = std::ranges::find(inner, wanted, &CommandWords::name);
    if (found == inner.end()) {
      const std::vector<std::string> names = command_names(*named.words);
      const std::string mend = did_you_mean(wanted, names, "", "'");
      throw UsageError(fmt::format("wanted a {} ({}), found {}{}{} {}",
                                   named.words == &root ? "command" : "benchmark", fmt::join(names, ", "),
                                   given ? "'" + wanted + "'" : "none", mend.empty() ? "" : ": ", mend,
                                   see_help(*named.words)));
    }
    named = {&*found, named.next + 1};
  }
}

const OptionWords* find_option(const CommandWords& command, const std::string& name) {
  const auto has_name = [&](const OptionWords& option) { return std::ranges::count(option.names, name) > 0; };
  const auto found = std::ranges::find_if(command.options, has_name);
  return found == command.options.end() ? nullptr : &*found;
}

/// The option; never null. Throws UsageError if it is unknown.
const OptionWords* option_named(const CommandWords& command, const std::string& name) {
  if (const OptionWords* option = find_option(command, name)) return option;
  std::vector<std::string> known;
  for (const OptionWords& option : command.options)
    for (const std::string& each : option.names)
      if (each.starts_with("--")) known.push_back(each);
  const std::string mend = name.starts_with("--") ? did_you_mean(name, known, "", "") : "";
  throw UsageError(
      fmt::format("unknown option {}{}{} {}", name, mend.empty() ? "" : ": ", mend, see_help(command)));
}

/// The option whose value must be the next word; null if there is none. `word` is "--name", "--name=value",
/// "-n", "-nvalue", or several flags in one ("-qv").
const OptionWords* option_without_value(const CommandWords& command, const std::string& word) {
  if (word.starts_with("--")) {
    const std::size_t equals = word.find('=');
    const OptionWords* option = option_named(command, word.substr(0, equals));
    return equals == word.npos && option->takes_value ? option : nullptr;
  }
  for (std::size_t i = 1; i < word.size(); ++i)
    if (const OptionWords* option = option_named(command, fmt::format("-{}", word[i])); option->takes_value)
      return i + 1 == word.size() ? option : nullptr;
  return nullptr;
}

/// Throws UsageError for unknown options and missing values. CLI11 reports missing arguments before unknown
/// options, and takes the next option for a forgotten value. (A value that looks like an option can be given
/// as
/// --stats=-o.)
void check_options(const NamedCommand& command, int argc, const char* const* argv) {
  for (int i = command.next; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--") return;
    if (word.size() < 2 || word[0] != '-') continue;
    // An empty text results from "$SAMPLES" if the variable is not set.
    const auto refuse_empty = [&](std::string_view name, const OptionWords& option) {
      throw UsageError(fmt::format("{} wants a value ({}), found an empty text {}", name, option.type,
                                   see_help(*command.words)));
    };
    if (word.starts_with("--") && word.find('=') == word.size() - 1) {
      const std::string name = word.substr(0, word.size() - 1);
      const OptionWords* option = find_option(*command.words, name);
      if (option && option->takes_value) refuse_empty(name, *option);
    }
    const OptionWords* option = option_without_value(*command.words, word);
    if (!option || ++i == argc) continue;
    const std::string next = argv[i];
    if (next.empty()) refuse_empty(word, *option);
    if (next.size() > 1 && next[0] == '-' && find_option(*command.words, next))
      throw UsageError(fmt::format("{} wants a value ({}), found the option {} {}", word, option->type, next,
                                   see_help(*command.words)));
  }
}

}  // namespace

const CommandWords& check_words(const CommandWords& root, int argc, const char* const* argv) {
  const NamedCommand named = find_command(root, argc, argv);
  check_options(named, argc, argv);
  return *named.words;
}

std::string see_help(const CommandWords& command) { return fmt::format("(see {} --help)", command.line); }

std::vector<std::string> command_names(const CommandWords& parent) {
  std::vector<std::string> names;
  for (const CommandWords& command : parent.commands)
    if (!command.hidden) names.push_back(command.name);
  return names;
}

}  // namespace sundog
