// Options of a command line, without the header of the library that reads them: CLI11 takes seconds in each
// file that includes it. The calls have its names.
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace sundog {

class Option {
 public:
  explicit Option(CLI::Option* option) : option_(option) {}
  Option* required();
  Option* hidden();                              // in no help
  Option* type_name(const std::string& name);    // as the help shows its value
  Option* expected(int count);                   // values behind it
  Option* one_value_each();                      // may be given several times, each time with one value
  Option* range(double low, double high);        // both ends included
  Option* positive();                            // above 0
  Option* one_of(std::vector<std::string> all);  // of these texts

 private:
  CLI::Option* option_;
};

/// A command, or a program: its options and its own commands. What is declared lives as long as it does.
class Arguments {
 public:
  explicit Arguments(const std::string& about, const std::string& name = "");
  ~Arguments();
  Arguments(const Arguments&) = delete;
  Arguments& operator=(const Arguments&) = delete;

  Arguments* add_subcommand(const std::string& name, const std::string& about);
  void require_subcommand(int count);
  /// Called once this command is chosen and its options are read.
  void callback(std::function<void()> call);
  /// `target` keeps its value where the option is not given.
  template <class T>
  Option* add_option(const std::string& name, T& target, const std::string& help = "");
  Option* add_flag(const std::string& name, bool& target, const std::string& help);

  /// The library's own, for what is not here.
  CLI::App& parser() { return *app_; }

 private:
  explicit Arguments(CLI::App* app);
  Option* keep(CLI::Option* option);

  std::unique_ptr<CLI::App> root_;  // of a program; null for a command of another
  CLI::App* app_;
  std::vector<std::unique_ptr<Arguments>> commands_;
  std::vector<std::unique_ptr<Option>> options_;
};

}  // namespace sundog
