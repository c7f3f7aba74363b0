// `sundog tune`: finds and keeps what is fastest on a device; --show, --forget, --export and --import what is
// kept.
#pragma once
#include "app/options/options.h"

namespace sundog {

class Arguments;

void add_tune(Arguments& root, Command& chosen);

}  // namespace sundog
