// `sundog bake`: a map of a detailed model for a plain one.
#pragma once
#include "app/options/options.h"

namespace sundog {

class Arguments;

void add_bake(Arguments& root, Command& chosen);

}  // namespace sundog
