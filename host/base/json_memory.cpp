// Counts values in one scan of the text, without parsing.
#include "base/json_memory.h"

#include <fmt/format.h>

#include "base/error.h"
#include "base/memory.h"

namespace sundog {
namespace {

/// The position after a string's closing quote; `at` is after the opening one.
std::size_t end_of_string(std::string_view text, std::size_t at) {
  while (true) {
    at = text.find_first_of("\"\\", at);
    if (at == std::string_view::npos) return text.size();
    if (text[at] == '"') return at + 1;
    at += 2;
  }
}

/// The position after the comment that begins at `at`, or after a lone slash.
std::size_t end_of_comment(std::string_view text, std::size_t at) {
  const std::string_view begin = text.substr(at, 2);
  const std::string_view end = begin == "//" ? "\n" : begin == "/*" ? "*/" : "";
  if (end.empty()) return at + 1;
  const std::size_t found = text.find(end, at + 2);
  return found == std::string_view::npos ? text.size() : found + end.size();
}

}  // namespace

JsonCounts count_json(std::string_view text) {
  JsonCounts counts{.values = 1};
  for (std::size_t at = 0; at < text.size();) {
    const char c = text[at];
    if (c == '"') {
      ++counts.strings;
      at = end_of_string(text, at + 1);
      continue;
    }
    if (c == '/') {
      at = end_of_comment(text, at);
      continue;
    }
    counts.containers += c == '[' || c == '{';
    counts.keys += c == ':';
    counts.values += c == ',' || c == '[' || c == '{';
    ++at;
  }
  return counts;
}

std::uint64_t json_bytes(const JsonCounts& counts) {
  constexpr std::uint64_t a_value = 24;               // 16, in growing vectors
  constexpr std::uint64_t a_container = 48;           // the vector or tree, and its allocation
  constexpr std::uint64_t a_string = 40, a_key = 40;  // a short string; a tree node
  return a_value * counts.values + a_container * counts.containers + a_string * counts.strings +
         a_key * counts.keys;
}

void check_json_memory(std::string_view text, const std::filesystem::path& file) {
  constexpr std::uint64_t always = std::uint64_t{160} << 20, most_ratio = 20;
  const JsonCounts counts = count_json(text);
  const std::uint64_t wanted = json_bytes(counts);
  if (wanted <= always) return;
  const auto fail = [&](const std::string& than) {
    throw SceneError(file.string(), "",
                     fmt::format("its {} arrays and objects take {} MiB of memory, {}", counts.containers,
                                 wanted >> 20, than));
  };
  if (wanted / most_ratio > text.size())
    fail(fmt::format("{} times the length of the file: no scene or model is so empty", wanted / text.size()));
  if (const std::uint64_t there = available_memory().value_or(wanted); wanted > there)
    fail(fmt::format("and {} MiB are available", there >> 20));
}

}  // namespace sundog
