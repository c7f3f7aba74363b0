// The library's version, and what its names are made visible with.
#pragma once
#if __cplusplus < 201709L  // C++20, as GCC 10 numbers it
#error "sundog's C++ headers need C++20: compile with -std=c++20, or use the C interface, <sundog/sundog.h>"
#endif
#include <string>

/// Semantic version: programs built against MAJOR.MINOR run with every library of the same MAJOR and, while
/// MAJOR is 0, of the same MINOR.
#define SUNDOG_VERSION_MAJOR 0
#define SUNDOG_VERSION_MINOR 1
#define SUNDOG_VERSION_PATCH 0

#define SUNDOG_API __attribute__((visibility("default")))

namespace sundog {
/// The version of the interface is part of the symbols' names; programs write sundog::Scene and the like.
inline namespace v0 {

/// "0.1.0": the version of the library that runs, which may be newer than the headers. Any thread.
SUNDOG_API std::string version();

}  // namespace v0
}  // namespace sundog
