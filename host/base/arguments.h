// Wraps CLI11's command-line options, because its header takes seconds to compile in each file that includes
// it. Functions have CLI11's names.
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
  Option* hidden();                              // omitted from help
  Option* type_name(const std::string& name);    // the word for the value in help
  Option* one_value_each();                      // may be repeated, with one value each time
  Option* range(double low, double high);        // inclusive
  Option* positive();                            // above 0
  Option* one_of(std::vector<std::string> all);  // allowed values

 private:
  CLI::Option* option_;
};

/// A program or a command: its options and subcommands. Targets of options must outlive it.
class Arguments {
 public:
  explicit Arguments(const std::string& about, const std::string& name = "");
  ~Arguments();
  Arguments(const Arguments&) = delete;
  Arguments& operator=(const Arguments&) = delete;

  Arguments* add_subcommand(const std::string& name, const std::string& about);
  Arguments* hidden();  // omitted from help
  void require_subcommand(int count);
  /// Called after parsing if this command was chosen.
  void callback(std::function<void()> call);
  /// `target` keeps its value if the option is not given.
  template <class T>
  Option* add_option(const std::string& name, T& target, const std::string& help = "");
  Option* add_flag(const std::string& name, bool& target, const std::string& help);

  /// The underlying CLI11 parser, for rarer calls.
  CLI::App& parser() { return *app_; }

 private:
  explicit Arguments(CLI::App* app);
  Option* keep(CLI::Option* option);

  std::unique_ptr<CLI::App> root_;  // the parser, if this is a program; null for a subcommand
  CLI::App* app_;
  std::vector<std::unique_ptr<Arguments>> commands_;
  std::vector<std::unique_ptr<Option>> options_;
};

}  // namespace sundog
