// Starts this program again, for work that may crash, hang or run beside it.
#pragma once
#include <sys/types.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "base/environment.h"

namespace sundog {

/// The path of this program's file; works without /proc too.
std::filesystem::path program_file();

/// Starts this program with `arguments` (without its name). Adds `variables` ("NAME=VALUE") to its
/// environment and hands down `descriptors`; stdin and stdout not among these are /dev/null. Throws IoError.
pid_t spawn_self(std::vector<std::string> arguments, std::vector<HandedDown> descriptors,
                 const std::vector<std::string>& variables = {});

/// spawn_self() as a StartProgram for the layers below (base/environment.h).
std::unique_ptr<StartedProgram> start_self(std::vector<std::string> arguments,
                                           std::vector<HandedDown> descriptors);

/// Waits until the process has ended. Returns its status as waitpid() does.
int wait_for_end(pid_t process);

}  // namespace sundog
