// Runs this program in a child process, for work that may crash or hang.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "app/process/spawn_self.h"

namespace sundog {

struct ChildResult {
  int status = -1;  // exit status
  int signal = 0;   // the signal that ended it; 0: none
  bool timed_out = false;
};

/// Runs this program with `arguments`; `variables` ("NAME=VALUE") are added to its environment. `on_line`
/// receives each line of its stdout; stdin and stderr are /dev/null unless `descriptors` include them. Kills
/// it after `seconds`. Throws IoError if it cannot be started.
ChildResult run_self(const std::vector<std::string>& arguments, const std::vector<std::string>& variables,
                     double seconds, const std::function<void(const std::string&)>& on_line,
                     std::vector<HandedDown> descriptors = {});

}  // namespace sundog
