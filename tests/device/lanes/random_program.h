// Random plain programs, for comparing lanes with one path.
#pragma once
#include <string>

namespace sundog {

/// Functions f0 ... f(count - 1) of `float x, float y, int k, UNIFORM int n, UNIFORM __global const float* q,
/// float* o`, marked ENTRY, and structures: branches, loops, arrays, early returns, calls among them. Where
/// lanes are off, some divide by zero, read far outside of q and loop for ever. The same text for the same
/// seed.
std::string random_program(unsigned seed, int count);

}  // namespace sundog
