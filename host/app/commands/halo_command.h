// `sundog halo`: the sky's map of a halo as a picture.
#pragma once
#include "app/options/options.h"

namespace sundog {

class Arguments;

void add_halo(Arguments& root, Command& chosen);

}  // namespace sundog
