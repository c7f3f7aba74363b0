// `sundog kernels`: what is made of the plain kernel files.
#pragma once
#include "app/options/options.h"

namespace sundog {

class Arguments;

/// Declares the command: lists the plain files, or prints one in lanes, or what varies in it and why.
void add_kernels(Arguments& root, Command& chosen);

}  // namespace sundog
