// `sundog check`: a doctor's report of drivers, caches and devices.
#pragma once
#include "app/options/options.h"

namespace sundog {

class Arguments;

void add_check(Arguments& root, Command& chosen);

}  // namespace sundog
