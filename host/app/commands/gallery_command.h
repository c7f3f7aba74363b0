// `sundog gallery`: scenes as pictures on one page.
#pragma once
#include "app/options/options.h"

namespace sundog {

class Arguments;

void add_gallery(Arguments& root, Command& chosen);

}  // namespace sundog
