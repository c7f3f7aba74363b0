// `sundog check`: a doctor's report of drivers, caches and devices.
#pragma once
#include "app/options.h"

namespace CLI {
class App;
}

namespace sundog {

void add_check(CLI::App& root, Command& chosen);

}  // namespace sundog
