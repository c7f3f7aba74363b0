// `sundog tune`: finds and keeps what is fastest on a device; --show, --forget, --export and --import what is
// kept.
#pragma once
#include "app/options.h"

namespace CLI {
class App;
}

namespace sundog {

void add_tune(CLI::App& root, Command& chosen);

}  // namespace sundog
