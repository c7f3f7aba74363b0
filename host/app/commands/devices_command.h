// `sundog devices`: every platform and device, with what each can do.
#pragma once
#include "app/options/options.h"

namespace sundog {

/// Prints a table, or with `json` an object of schema 1, to stdout. Returns the exit status: 0 also where
/// nothing is usable, for the list is what was asked for.
int devices_command(const DevicesOptions& options);

}  // namespace sundog
