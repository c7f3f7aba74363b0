// The manual's options are those of the program: each one that a command knows stands in its page, and each
// one in a table of options is known.
#include <fmt/format.h>

#include <map>
#include <regex>
#include <set>
#include <sstream>

#include "base/file.h"
#include "catch.h"
#include "run_command.h"

namespace {

/// The page under docs/ that describes each command.
const std::map<std::string, std::string> pages{{"render", "reference/command-line"},
                                               {"merge", "reference/command-line"},
                                               {"info", "reference/command-line"},
                                               {"formulas", "reference/command-line"},
                                               {"kernels", "reference/command-line"},
                                               {"compare", "reference/command-line"},
                                               {"bake", "guide/textures"},
                                               {"devices", "guide/devices"},
                                               {"check", "guide/devices"},
                                               {"tune", "guide/devices"},
                                               {"bench workgroup", "guide/benchmarks"},
                                               {"bench threads", "guide/benchmarks"},
                                               {"bench devices", "guide/benchmarks"},
                                               {"bench rays", "guide/benchmarks"},
                                               {"bench samples", "guide/benchmarks"},
                                               {"bench quality", "guide/benchmarks"},
                                               {"bench kernels", "guide/benchmarks"},
                                               {"bench textures", "guide/benchmarks"},
                                               {"bench roofline", "guide/benchmarks"},
                                               {"bench compare", "guide/benchmarks"},
                                               {"gallery", "reference/command-line"},
                                               {"mix", "reference/command-line"},
                                               {"serve", "guide/viewer"},
                                               {"halo", "guide/halo"}};

/// The long options in a text: "--size", as a whole.
std::set<std::string> options_in(const std::string& text) {
  static const std::regex option("(^|[^-\\w])(--[a-z][a-z-]*)");
  std::set<std::string> all;
  for (std::sregex_iterator it(text.begin(), text.end(), option), end; it != end; ++it) all.insert((*it)[2]);
  return all;
}

/// The options that `--help` of a command lists, without --help.
std::set<std::string> known_options(const std::string& command) {
  std::vector<std::string> arguments;
  std::istringstream words(command);
  for (std::string word; words >> word;) arguments.push_back(word);
  arguments.push_back("--help");
  const CommandResult help = run_sundog(arguments);
  REQUIRE(help.status == 0);
  std::set<std::string> all;
  std::istringstream lines(help.out);
  static const std::regex option("^  (-\\w,)?(--[a-z][a-z-]*).*");
  for (std::string line; std::getline(lines, line);)
    if (std::smatch found; std::regex_match(line, found, option) && found[2] != "--help")
      all.insert(found[2]);
  return all;
}

/// The commands that `--help` lists, those of `bench` too.
std::vector<std::string> all_commands(const std::string& parent = "") {
  const CommandResult help = parent.empty() ? run_sundog({"--help"}) : run_sundog({parent, "--help"});
  REQUIRE(help.status == 0);
  std::istringstream lines(help.out.substr(help.out.find("Subcommands:")));
  std::vector<std::string> all;
  static const std::regex command("^  ([a-z]+) .*");
  for (std::string line; std::getline(lines, line);)
    if (std::smatch found; std::regex_match(line, found, command) && found[1] != "bench")
      all.push_back(parent.empty() ? found[1].str() : parent + " " + found[1].str());
  return all;
}

std::string page_text(const std::string& name) {
  return sundog::read_file(fmt::format(SUNDOG_SOURCE_DIR "/docs/{}.md", name));
}

/// The first cells of the tables that list options or commands.
std::string first_cells(const std::string& page) {
  std::string cells;
  std::istringstream lines(page);
  bool is_option_table = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("| option")) is_option_table = true;
    if (!line.starts_with("|")) is_option_table = false;
    if (is_option_table) cells += line.substr(0, line.find('|', 1)) + "\n";
  }
  return cells;
}

}  // namespace

TEST_CASE("every command has a page in the manual") {
  for (const char* parent : {"", "bench"})
    for (const std::string& command : all_commands(parent)) {
      INFO("no page is named for the command " << command);
      CHECK(pages.contains(command));
    }
}

TEST_CASE("the manual has every option of every command, and no other") {
  std::map<std::string, std::set<std::string>> known;
  for (const auto& [command, page] : pages) {
    const std::set<std::string> there = options_in(page_text(page));
    for (const std::string& option : known_options(command)) {
      INFO("docs/" << page << ".md: " << command << " " << option);
      CHECK(there.contains(option));
      known[page].insert(option);
    }
  }
  std::size_t count = 0;
  for (const auto& [page, options] : known)
    for (const std::string& option : options_in(first_cells(page_text(page)))) {
      INFO("docs/" << page << ".md: " << option << " is no option of its commands");
      CHECK(options.contains(option));
      ++count;
    }
  CHECK(count > 30);
}
