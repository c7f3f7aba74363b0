// The names that the shared library and its headers show.
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>

#include "catch.h"
#include "run_command.h"

namespace fs = std::filesystem;

TEST_CASE("the shared library shows its public names and no others") {
  const CommandResult listed = run_command({"nm", "-D", "-C", "--defined-only", SUNDOG_SHARED_LIBRARY});
  CAPTURE(listed.err);
  REQUIRE(listed.status == 0);
  const std::regex wanted(
      R"(\w+ \w ((typeinfo|typeinfo name|vtable) for sundog::v0::Error|sundog::v0::.*|sundog_\w+))");
  std::istringstream lines(listed.out);
  int names = 0;
  for (std::string line; std::getline(lines, line); ++names) {
    CAPTURE(line);
    CHECK(std::regex_match(line, wanted));
    CHECK(line.find("Impl::") == std::string::npos);
  }
  CHECK(names > 60);
}

TEST_CASE("public headers include nothing but the language's own and each other") {
  int headers = 0;
  const std::regex include(R"(#\s*include ([<"])([^>"]+)[>"])"), language(R"([a-z_]+|std(def|int)\.h)");
  for (const auto& entry : fs::directory_iterator(fs::path(SUNDOG_SOURCE_DIR) / "include/sundog")) {
    CAPTURE(entry.path());
    ++headers;
    std::ifstream file(entry.path());
    std::smatch match;
    for (std::string line; std::getline(file, line);) {
      if (!std::regex_search(line, match, include)) continue;
      const std::string name = match[2];
      CAPTURE(name);
      CHECK(match[1] == "<");
      CHECK((name.starts_with("sundog/") || std::regex_match(name, language)));
    }
  }
  CHECK(headers == 9);
}

TEST_CASE("public headers compile without a warning, the one for C as C99") {
  const std::string folder = std::string(SUNDOG_SOURCE_DIR) + "/include";
  const std::vector<std::vector<std::string>> compilers{
      {"c++", "-std=c++20", "-xc++", "-include", "sundog/sundog.hpp"},
      {"c++", "-std=c++20", "-xc++", "-include", "sundog/sundog.h"},
      {"cc", "-std=c99", "-xc", "-include", "sundog/sundog.h"}};
  for (std::vector<std::string> command : compilers) {
    for (const char* argument :
         {"-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wshadow", "-Werror", "-fsyntax-only"})
      command.emplace_back(argument);
    command.insert(command.end(), {"-I" + folder, "/dev/null"});
    const CommandResult compiled = run_command(command);
    CAPTURE(command, compiled.err);
    CHECK(compiled.status == 0);
  }
}

TEST_CASE("the first error of a program compiled as C++17 says that C++20 is needed") {
  for (const char* header : {"sundog.hpp", "scene.h", "image.h", "devices.h", "session.h", "error.h"}) {
    const CommandResult compiled =
        run_command({"c++", "-std=c++17", "-xc++", "-fsyntax-only", "-I" SUNDOG_SOURCE_DIR "/include",
                     "-include", std::string("sundog/") + header, "/dev/null"});
    CAPTURE(header, compiled.err);
    CHECK(compiled.status != 0);
    const std::size_t error = compiled.err.find("error: ");
    REQUIRE(error != std::string::npos);
    CHECK(compiled.err.substr(error, 60).find("C++20") != std::string::npos);
  }
}
