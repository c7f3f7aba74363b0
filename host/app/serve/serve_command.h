// `sundog serve`: the viewer as a page that a browser on this machine, or at the end of an ssh tunnel, shows.
#pragma once
#include "app/options/options.h"

namespace sundog {

class Arguments;

/// Declares the command: prints one URL, serves until it is interrupted.
void add_serve(Arguments& root, Command& chosen);

}  // namespace sundog
