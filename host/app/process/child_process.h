// Runs this program again, for what may crash or hang.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "app/process/spawn_self.h"

namespace sundog {

struct ChildResult {
  int status = -1;  // exit status
  int signal = 0;   // not 0: what ended it
  bool timed_out = false;
};

/// Runs this very program with `arguments`; `variables` ("NAME=VALUE") are added to its environment.
/// `on_line` hears each line of its stdout; its stdin and stderr, unless they are among `descriptors`, are
/// nowhere. Killed after `seconds`. Throws IoError when it cannot be started.
ChildResult run_self(const std::vector<std::string>& arguments, const std::vector<std::string>& variables,
                     double seconds, const std::function<void(const std::string&)>& on_line,
                     std::vector<HandedDown> descriptors = {});

}  // namespace sundog
