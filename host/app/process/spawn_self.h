// Starts this program again, for work that may crash, hang or run beside it.
#pragma once
#include <sys/types.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "base/environment.h"

namespace sundog {

/// This program's file, by its path; also where /proc is not mounted.
std::filesystem::path program_file();

/// Starts this very program with `arguments` (without its own name); `variables` ("NAME=VALUE") are added to
/// its environment, `descriptors` handed down; its stdin and stdout, unless they are among these, are
/// nowhere. Throws IoError.
pid_t spawn_self(std::vector<std::string> arguments, std::vector<HandedDown> descriptors,
                 const std::vector<std::string>& variables = {});

/// spawn_self() as a StartProgram for the layers below (base/environment.h).
std::unique_ptr<StartedProgram> start_self(std::vector<std::string> arguments,
                                           std::vector<HandedDown> descriptors);

/// Waits until the process has ended; its status as waitpid gives it.
int wait_for_end(pid_t process);

}  // namespace sundog
