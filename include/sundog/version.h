// The library's version, and the macro that exports its symbols.
#pragma once
#if __cplusplus < 201709L  // C++20, as GCC 10 numbers it
#error "sundog's C++ headers need C++20: compile with -std=c++20, or use the C interface, <sundog/sundog.h>"
#endif
#include <string>

/// Semantic version: programs built against MAJOR.MINOR run with every library of the same MAJOR and, while
/// MAJOR is 0, of the same MINOR.
#define SUNDOG_VERSION_MAJOR 0
#define SUNDOG_VERSION_MINOR 2
#define SUNDOG_VERSION_PATCH 0

#define SUNDOG_API __attribute__((visibility("default")))

namespace sundog {
/// Part of the symbols' names; programs write sundog::Scene and the like.
inline namespace v0 {

/// The version of the running library ("0.2.0"), which may be newer than the headers. Thread-safe.
SUNDOG_API std::string version();

}  // namespace v0
}  // namespace sundog
