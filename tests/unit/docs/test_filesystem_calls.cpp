// A folder that may not be entered is no reason to end: calls of the file system take an error code. Without
// one they throw where a person sees only a missing picture.
#include <algorithm>
#include <filesystem>
#include <regex>
#include <string>
#include <vector>

#include "base/file.h"
#include "catch.h"

namespace {

namespace fs = std::filesystem;

/// The last of the arguments of a call whose parenthesis opens at `open`.
std::string last_argument(const std::string& text, std::size_t open) {
  int depth = 0;
  std::size_t begin = open + 1, at = open;
  for (; at < text.size(); ++at) {
    depth += (text[at] == '(' || text[at] == '{') - (text[at] == ')' || text[at] == '}');
    if (depth == 0) break;
    if (depth == 1 && text[at] == ',') begin = at + 1;
  }
  std::string argument = text.substr(begin, at - begin);
  std::erase(argument, ' ');
  std::erase(argument, '\n');
  return argument;
}

std::string without_comments(const std::string& text) {
  return std::regex_replace(text, std::regex("//[^\n]*"), "");
}

}  // namespace

TEST_CASE("calls of the file system take an error code") {
  const std::regex call(
      R"((?:fs|std::filesystem)::(exists|is_\w+|file_size|last_write_time|remove|remove_all|rename|create_director\w+|create_symlink|current_path|absolute|canonical|weakly_canonical|temp_directory_path|read_symlink|space|status|copy\w*|relative|equivalent|resize_file|permissions)\()");
  const std::regex code(R"(std::error_code (\w+)|fs::file_status (\w+))");
  const fs::path root = SUNDOG_SOURCE_DIR;
  std::vector<fs::path> sources;
  for (const char* top : {"host", "bench/commands", "bench/runs"})
    for (const auto& entry : fs::recursive_directory_iterator(root / top)) sources.push_back(entry.path());
  int calls = 0;
  for (const fs::path& source : sources) {
    const std::string extension = source.extension().string();
    if (extension != ".cpp" && extension != ".h") continue;
    const std::string text = without_comments(sundog::read_file(source));
    std::vector<std::string> codes;
    for (std::sregex_iterator it(text.begin(), text.end(), code), end; it != end; ++it)
      codes.push_back((*it)[1].matched ? (*it)[1] : (*it)[2]);
    for (std::sregex_iterator it(text.begin(), text.end(), call), end; it != end; ++it, ++calls) {
      const auto open = static_cast<std::size_t>(it->position() + it->length()) - 1;
      const std::string last = last_argument(text, open);
      CAPTURE(source.string(), it->str(), last);
      CHECK(std::ranges::count(codes, last) > 0);
    }
  }
  CHECK(calls > 40);
}
