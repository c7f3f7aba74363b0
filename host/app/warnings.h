// Warnings: one line each on stderr, never on stdout.
#pragma once
#include <fmt/format.h>

#include <cstdio>
#include <span>
#include <string>

namespace sundog {

inline void print_warnings(std::span<const std::string> warnings) {
  for (const std::string& warning : warnings) fmt::print(stderr, "sundog: warning: {}\n", warning);
}

}  // namespace sundog
