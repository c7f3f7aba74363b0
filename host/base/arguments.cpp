// Implements command-line options with CLI11, whose header only this file and command_line.cpp include.
#include "base/arguments.h"

#include <CLI/CLI.hpp>

namespace sundog {

Option* Option::required() { return option_->required(), this; }
Option* Option::hidden() { return option_->group(""), this; }
Option* Option::type_name(const std::string& name) { return option_->type_name(name), this; }
Option* Option::range(double low, double high) {
  // Show whole bounds as integers.
  if (low == static_cast<int>(low) && high == static_cast<int>(high))
    return option_->check(CLI::Range(static_cast<int>(low), static_cast<int>(high))), this;
  return option_->check(CLI::Range(low, high)), this;
}
Option* Option::positive() { return option_->check(CLI::PositiveNumber), this; }
Option* Option::one_of(std::vector<std::string> all) {
  return option_->check(CLI::IsMember(std::move(all))), this;
}
Option* Option::one_value_each() {
  option_->expected(1)->allow_extra_args(false)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  return this;
}

Arguments::Arguments(const std::string& about, const std::string& name)
    : root_(std::make_unique<CLI::App>(about, name)), app_(root_.get()) {}
Arguments::Arguments(CLI::App* app) : app_(app) {}
Arguments::~Arguments() = default;

Arguments* Arguments::hidden() { return app_->group(""), this; }

Arguments* Arguments::add_subcommand(const std::string& name, const std::string& about) {
  commands_.emplace_back(new Arguments(app_->add_subcommand(name, about)));
  return commands_.back().get();
}

void Arguments::require_subcommand(int count) { app_->require_subcommand(count); }
void Arguments::callback(std::function<void()> call) { app_->callback(std::move(call)); }

Option* Arguments::keep(CLI::Option* option) {
  options_.push_back(std::make_unique<Option>(option));
  return options_.back().get();
}

template <class T>
Option* Arguments::add_option(const std::string& name, T& target, const std::string& help) {
  return keep(app_->add_option(name, target, help));
}
template Option* Arguments::add_option(const std::string&, std::string&, const std::string&);
template Option* Arguments::add_option(const std::string&, int&, const std::string&);
template Option* Arguments::add_option(const std::string&, unsigned&, const std::string&);
template Option* Arguments::add_option(const std::string&, double&, const std::string&);
template Option* Arguments::add_option(const std::string&, std::vector<std::string>&, const std::string&);

Option* Arguments::add_flag(const std::string& name, bool& target, const std::string& help) {
  return keep(app_->add_flag(name, target, help));
}

}  // namespace sundog
