// Runs a program as a user or a script would, and keeps its output.
#pragma once
#include <csignal>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

struct CommandOptions {
  std::map<std::string, std::string>
      environment;               // added to the tests' own; an empty value removes a variable
  std::filesystem::path folder;  // to run in; empty: the current one
  bool terminal = false;         // stderr is a terminal (80 columns), else a pipe; stdin is always empty
  std::string signal_at;         // send `signal` when this text appears on stderr; empty: never
  std::filesystem::path signal_folder;  // ... or when this folder is not empty; empty path: never
  int signal = SIGINT;
  bool hang_up = false;        // close the terminal and send `signal` twice
  std::size_t file_limit = 0;  // no file may grow larger (bytes); 0: no limit
  double timeout = 120;        // seconds until it is killed
};

struct CommandResult {
  int status = -1;  // exit status; 128 + N if signal N ended it
  bool timed_out = false;
  std::string out, err;
  double seconds = 0;  // from start to end
};

/// Runs `arguments[0]` with the other arguments and waits for it.
CommandResult run_command(const std::vector<std::string>& arguments, const CommandOptions& options = {});

/// Runs the built sundog with these arguments.
CommandResult run_sundog(std::vector<std::string> arguments, const CommandOptions& options = {});
