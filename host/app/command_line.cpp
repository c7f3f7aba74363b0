// Checks commands and options for misspellings (command_words.h), then has CLI11 parse them; each command
// adds its own options.
#include "app/command_line.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <cstdio>

#include "app/job/job.h"
#include "app/options/command_words.h"
#include "app/options/devices.h"
#include "app/process/revision.h"
#include "base/arguments.h"
#include "base/error.h"
#include "bench/commands/bench_options.h"
#include "models/model.h"

namespace sundog {
namespace {

constexpr const char* short_help =
    R"(sundog renders scenes with OpenCL, on any device there is.

  sundog render SCENE -o OUT.png   render a scene (.json) or a model ()" SUNDOG_MODEL_EXTENSIONS R"()
  sundog check                     check drivers, caches and devices
  sundog devices                   list the devices, for --device
  sundog info SCENE                what a scene holds
  sundog formulas                  the fractals and solids that scenes may name

All commands: {}.
`sundog --help` describes all commands, `sundog COMMAND --help` a command's options.
)";

CommandWords words_of(const CLI::App& app, const std::string& before = "") {
  CommandWords words{app.get_name(), before + app.get_name(), {}, {}, app.get_group().empty()};
  for (const CLI::Option* option : app.get_options()) {
    const std::string type = option->get_type_name();  // ends with ":CHECK" if the value is checked
    OptionWords one{{}, option->get_items_expected_min() > 0, type.substr(0, type.find(':'))};
    for (const std::string& name : option->get_lnames()) one.names.push_back("--" + name);
    for (const std::string& name : option->get_snames()) one.names.push_back("-" + name);
    words.options.push_back(one);
  }
  for (const CLI::App* command : app.get_subcommands(nullptr))
    words.commands.push_back(words_of(*command, words.line + " "));
  return words;
}

/// Shows a text. All processes of a job have the same command line, so only rank 0 reports errors.
Command text_command(const std::string& text, int status = exit_done) {
  const auto show = [text, status] {
    if (status == exit_done || job_rank() <= 0) fmt::print(status == exit_done ? stdout : stderr, "{}", text);
    return status;
  };
  return {.run = show, .in_first_thread = true, .only_prints = status == exit_done};
}

/// Shows the facts that a bug report should state. Flushes the first lines in case a driver crashes.
int show_version() {
  fmt::print("sundog " SUNDOG_VERSION "\nrevision {}\n", build_revision());
  std::fflush(stdout);
  for (const DeviceInfo& device : list_devices())
    if (device.usable()) fmt::print("device {}, driver {}\n", device.label(), device.driver);
  return exit_done;
}

}  // namespace

Command parse_command_line(int argc, const char* const* argv) {
  remember_command_line(argc, argv);
  Arguments arguments("sundog renders scenes with OpenCL, on any device there is.", "sundog");
  CLI::App& root = arguments.parser();
  root.set_version_flag("--version", SUNDOG_VERSION);
  root.require_subcommand(1);
  Command chosen;
#define SUNDOG_COMMAND(name) add_##name(arguments, chosen);
  SUNDOG_COMMANDS(SUNDOG_COMMAND)
#undef SUNDOG_COMMAND
  const CommandWords words = words_of(root);
  if (argc < 2)
    return text_command(fmt::format(short_help, fmt::join(command_names(words), ", ")), exit_usage);
  const CommandWords& named = check_words(words, argc, argv);
  try {
    root.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    return text_command(root.help());
  } catch (const CLI::CallForVersion&) {
    return {.run = show_version, .only_prints = true};
  } catch (const CLI::ExtrasError&) {
    throw UsageError(
        fmt::format("unknown argument: {} {}", fmt::join(root.remaining(true), " "), see_help(named)));
  } catch (const CLI::ParseError& error) {
    throw UsageError(fmt::format("{} {}", error.what(), see_help(named)));
  }
  return chosen;
}

}  // namespace sundog
