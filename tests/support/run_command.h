// Runs a program as a user or a script would, and keeps what it said.
#pragma once
#include <csignal>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

struct CommandOptions {
  std::map<std::string, std::string>
      environment;               // on top of the tests' own; an empty value takes a variable away
  std::filesystem::path folder;  // to run in; empty: here
  bool terminal = false;         // stderr is a terminal (80 columns), else a pipe; stdin is always empty
  std::string signal_at;         // send `signal` when this text appears on stderr; empty: never
  std::filesystem::path signal_folder;  // ... or when something is in this folder; empty: never
  int signal = SIGINT;
  bool hang_up = false;        // the terminal is closed, and `signal` comes twice
  std::size_t file_limit = 0;  // no file may grow larger (bytes); 0: no limit
  double timeout = 120;        // seconds until it is killed
};

struct CommandResult {
  int status = -1;  // exit status; 128 + N when signal N ended it
  bool timed_out = false;
  std::string out, err;
  double seconds = 0;  // from start to end
};

/// `arguments[0]` is the program.
CommandResult run_command(const std::vector<std::string>& arguments, const CommandOptions& options = {});

/// The built sundog with these arguments.
CommandResult run_sundog(std::vector<std::string> arguments, const CommandOptions& options = {});
