// Prints messages for users, on stderr, never on stdout.
#pragma once
#include <fmt/format.h>

#include <cstdio>
#include <span>
#include <string>

namespace sundog {

/// Prints to stderr. Ignores errors: a terminal that is gone must not cost the frame.
inline void tell(const std::string& text) { std::fputs(text.c_str(), stderr); }

inline void print_warnings(std::span<const std::string> warnings) {
  for (const std::string& warning : warnings) tell(fmt::format("sundog: warning: {}\n", warning));
}

}  // namespace sundog
